// SPDX-License-Identifier: MIT
#include "renderer/scene/vdb_file.h"

#include <fmt/format.h>
#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Dense.h>

#include <cmath>
#include <cstddef>
#include <exception>

#include "atmosphere/base/error.h"
#include "atmosphere/base/parsing.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {
namespace {

using openvdb::FloatGrid;

/// Returns the names of a file's grids with the types of their values.
std::string TextOfGrids(openvdb::io::File& file) {
  std::string text;
  for (auto name = file.beginName(); name != file.endName(); ++name) {
    text += fmt::format("{}\"{}\" ({})", text.empty() ? "" : ", ", Printable(*name),
                        Printable(file.readGridMetadata(*name)->valueType()));
  }
  return text.empty() ? "none" : text;
}

/// Returns the name of the grid of floats that is asked for. @param wanted  as for ReadVdb.
std::string NameOfGrid(openvdb::io::File& file, std::string_view wanted) {
  std::string found;
  for (auto name = file.beginName(); name != file.endName(); ++name) {
    if (file.readGridMetadata(*name)->valueType() != "float") continue;
    if (*name == (wanted.empty() ? "density" : wanted)) return *name;
    if (wanted.empty() && found.empty()) found = *name;
  }
  if (!found.empty()) return found;
  const std::string named =
      wanted.empty() ? "" : fmt::format(" \"{}\"", Printable(std::string(wanted)));
  throw InputError(
      fmt::format("there is no grid{} of floats; the file has {}", named, TextOfGrids(file)));
}

/// Returns the distances between values along x, y and z.
glm::dvec3 SpacingOf(const FloatGrid& grid) {
  if (!grid.transform().isLinear()) throw InputError("the transform of the grid is not linear");
  const openvdb::Mat4d matrix = grid.transform().baseMap()->getAffineMap()->getMat4();
  glm::dvec3 spacing;
  for (int row = 0; row < 3; ++row) {
    spacing[row] = matrix(row, row);
    for (int column = 0; column < 3; ++column) {
      if (row != column && matrix(row, column) != 0.0)
        throw InputError("the transform turns or shears the grid; it may scale and move it");
    }
    if (!std::isfinite(spacing[row]) || spacing[row] == 0.0)
      throw InputError(fmt::format("the grid has the spacing {} along axis {}", spacing[row], row));
  }
  return spacing;
}

VdbGrid DenseOf(const FloatGrid& grid, double most_values) {
  const openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
  if (box.empty()) throw InputError("the grid has no active values");
  const openvdb::Coord size = box.dim();
  const double values = static_cast<double>(size.x()) * size.y() * size.z();
  if (values > most_values) {
    throw InputError(fmt::format("a box of {} x {} x {} values; there may be {:.0f} at most",
                                 size.x(), size.y(), size.z(), most_values));
  }
  const openvdb::Vec3d first = grid.transform().indexToWorld(box.min());
  VdbGrid dense{grid.getName(),
                {size.x(), size.y(), size.z()},
                {first.x(), first.y(), first.z()},
                SpacingOf(grid),
                grid.background(),
                std::vector<float>(static_cast<std::size_t>(values))};
  openvdb::tools::Dense<float, openvdb::tools::LayoutXYZ> view(box, dense.values.data());
  openvdb::tools::copyToDense(grid, view);
  return dense;
}

}  // namespace

VdbGrid ReadVdb(const std::filesystem::path& file, std::string_view grid_name, double most_values) {
  try {
    openvdb::initialize();
    openvdb::io::File stored(file.string());
    constexpr bool kLater = false;  // values are read at once
    stored.open(kLater);
    const auto grid =
        openvdb::gridConstPtrCast<FloatGrid>(stored.readGrid(NameOfGrid(stored, grid_name)));
    if (!grid) throw InputError("the grid of floats has an unusual tree");
    return DenseOf(*grid, most_values);
  } catch (const InputError& error) {
    RefuseFile(file, error.what());
  } catch (const std::exception& error) {
    RefuseFile(file, fmt::format("OpenVDB cannot read it: {}", Printable(error.what())));
  }
}

}  // namespace alpenglow::renderer
