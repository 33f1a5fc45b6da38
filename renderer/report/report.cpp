// SPDX-License-Identifier: MIT
#include "renderer/report/report.h"

#include "renderer/report/report_measure.h"

namespace alpenglow::renderer {
namespace {

ReportWords WordsOfReport() {
  return {
      .title = "Alpenglow: speed and accuracy of pictures",
      .lead =
          "What a picture of terrain in real air is made of, each part held against a slow judge: "
          "the air before mountains, the shafts of light and shade in it, lamps in fog, and whole "
          "pictures. Methods of this library and of the literature answer the same questions in "
          "one run.",
      .minute =
          "For each topic: the fastest method that nobody could tell from the truth in any of its "
          "columns. An error of 1 % in radiance is about the smallest step that an eye sees side "
          "by side.",
      .reading =
          "Every topic says what it is asked of and what its errors are relative to. Columns are "
          "heights of the sun, kinds of fog, numbers of lamps or times of the day. Where a method "
          "is not made for a column, its cells are empty. Methods of the literature use this "
          "library's columns, geometry and kernels: what is left of their errors is their own."};
}

}  // namespace

Report MeasurePictureReport(const ReportOptions& options) {
  const ReportEffort effort = options.quick ? ReportEffort::Quick() : ReportEffort{};
  std::vector<MeasureTopic> topics;
  for (const auto measure : {MeasureAerialPerspective, MeasureTransmittanceToTerrain}) {
    for (const Medium& medium : options.mediums)
      topics.emplace_back([measure, &medium, &effort] { return measure(medium, effort); });
  }
  for (const auto measure : {MeasureShafts, MeasureAirlight, MeasureManyLamps, MeasurePictures}) {
    topics.emplace_back([measure, &effort] { return measure(effort); });
  }
  return MeasureTopics(WordsOfReport(), options.quick, options.progress, topics);
}

}  // namespace alpenglow::renderer
