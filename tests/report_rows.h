// SPDX-License-Identifier: MIT
// Topics and rows of a report by name.
#pragma once

#include <string>

#include "atmosphere/error.h"
#include "lut/report.h"

namespace alpenglow::tests {

/// Throws InternalError when there is none.
inline const ReportTopic& TopicOf(const Report& report, const std::string& key) {
  for (const ReportTopic& topic : report.topics) {
    if (topic.key == key) return topic;
  }
  throw InternalError("no topic " + key);
}

/// Throws InternalError when there is none.
inline const ReportRow& RowOf(const Report& report, const std::string& topic,
                              const std::string& name) {
  for (const ReportRow& row : TopicOf(report, topic).rows) {
    if (row.Name() == name) return row;
  }
  throw InternalError("no row " + name);
}

}  // namespace alpenglow::tests
