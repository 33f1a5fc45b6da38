// SPDX-License-Identifier: MIT
// Provides PictureWriter, which makes the pictures of a flight that are written to files: still
// pictures, replays and films.
#pragma once

#include <filesystem>
#include <vector>

#include "lut/image/image.h"
#include "viewer/flight/flight_recorder.h"
#include "viewer/flight_session.h"

namespace alpenglow::viewer {

class PictureWriter {
 public:
  /// Keeps a reference to the flight.
  explicit PictureWriter(FlightSession& flight) : flight_(flight) {}

  /// Returns the linear picture as seen by the eye, with everything that is visible there. Any size
  /// is possible: a picture that OpenGL cannot draw as a whole is painted in tiles, and a panorama
  /// is assembled from perspectives. Throws OptionError if memory is insufficient.
  [[nodiscard]] HdrImage Picture(const ImageSize& size, int samples,
                                 const PictureProgress& progress = {});
  /// Paints the view again with several rays per pixel and writes it, linear or developed by the
  /// format of the file. The header has the settings of the picture. Throws OutputError, and
  /// OptionError for a name that is no picture's.
  void Write(const std::filesystem::path& file, const ImageSize& size,
             const PictureProgress& progress = {});
  /// Paints the picture of a window as Write does, and develops it onto a screen.
  /// @return the metadata of the picture.
  [[nodiscard]] Metadata PaintStill(const ToneMapPass::Screen& screen,
                                    const PictureProgress& progress = {});
  /// Writes pictures at equal time steps along the path, including both of its ends, and records
  /// their points.
  void WriteReplay(const CameraPath& path, const std::vector<std::filesystem::path>& files,
                   const ImageSize& size, FlightRecorder& recorder);
  /// Returns a developed picture of a film, `seconds` after the previous one, with adapted
  /// exposure.
  [[nodiscard]] DisplayImage Film(const ReplayFrame& frame, const ImageSize& size, double seconds);

 private:
  [[nodiscard]] HdrImage PictureOf(const PaintedView& view, int samples,
                                   const PictureProgress& progress);
  [[nodiscard]] Metadata HeaderOf(const PaintedView& view, const Development& development) const;

  FlightSession& flight_;
};

}  // namespace alpenglow::viewer
