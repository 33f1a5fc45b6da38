// SPDX-License-Identifier: MIT
// Evaluates the cases of a reader in parallel and writes a file of results, in the order of the
// cases, atomically, a few thousand cases at a time. Included by the sources that evaluate files.
#pragma once

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/base/finite.h"
#include "lut/cli/messages.h"
#include "lut/cli/output_file.h"
#include "lut/cli/program.h"
#include "lut/evaluate/eval.h"

namespace alpenglow::lut {

/// Returns "id,wavelength,value,error" and a line end; the error has three digits, rounded up.
/// Throws InternalError if one of them is not finite.
[[nodiscard]] inline std::string ResultLine(std::string_view id, std::string_view wavelength_nm,
                                            const Estimate& estimate) {
  const std::array<double, 2> results{estimate.value, estimate.error};
  RequireFinite(results, fmt::format("case {} at {} nm", id, wavelength_nm));
  return fmt::format("{},{},{},{:.3g}\n", id, wavelength_nm, estimate.value,
                     1.005 * estimate.error);
}

/// Evaluates all cases of a reader and writes the results.
/// @param reader   Next() returns an optional case with its line; bytes() and bytes_read() give the
///   progress; Fail(line, fault) throws an InputError.
/// @param prepare  called with every batch of cases before it is evaluated.
/// @param lines    returns the result lines of a case; thread-safe. The file and the line of the
///   case are put before the message of an InputError.
template <typename Reader, typename Prepare, typename Lines>
void WriteCaseResults(Reader& reader, const std::filesystem::path& results, ProgressStyle style,
                      const Prepare& prepare, const Lines& lines) {
  constexpr std::size_t kCasesAtOnce = 4096;
  using Work = typename decltype(reader.Next())::value_type;
  Progress progress("bytes of cases", reader.bytes(), style);
  WriteFileAtomically(results, [&](const std::filesystem::path& name) {
    std::ofstream out(name, std::ios::binary);
    out << "id,wavelength_nm,value,error\n";
    std::uint64_t done = 0;
    while (true) {
      std::vector<Work> batch;
      while (batch.size() < kCasesAtOnce) {
        std::optional<Work> next = reader.Next();
        if (!next) break;
        batch.push_back(std::move(*next));
      }
      if (batch.empty()) break;
      prepare(std::span<const Work>(batch));
      std::vector<std::string> texts(batch.size());
      tbb::parallel_for(std::size_t{0}, batch.size(), [&](std::size_t i) {
        if (Interrupted()) return;
        try {
          texts[i] = lines(batch[i]);
        } catch (const InputError& fault) {
          reader.Fail(batch[i].line, fault.what());
        }
      });
      ThrowIfInterrupted();
      for (const std::string& text : texts) out << text;
      if (!out) throw OutputError(name.string() + ": cannot be written");
      progress.Advance(reader.bytes_read() - done);
      done = reader.bytes_read();
    }
    out.close();
    if (!out) throw OutputError(name.string() + ": cannot be written");
  });
}

template <typename Reader, typename Lines>
void WriteCaseResults(Reader& reader, const std::filesystem::path& results, ProgressStyle style,
                      const Lines& lines) {
  WriteCaseResults(
      reader, results, style, [](const auto&) {}, lines);
}

}  // namespace alpenglow::lut
