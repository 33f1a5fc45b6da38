// SPDX-License-Identifier: MIT
#include "lut/report/report_pages.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <system_error>

#include "atmosphere/base/error.h"
#include "atmosphere/base/parsing.h"
#include "lut/cli/output_file.h"
#include "lut/image/png.h"
#include "lut/image/svg_elements.h"
#include "lut_report/embedded_text.h"

namespace alpenglow::lut {
namespace {

namespace fs = std::filesystem;

/// Formats a number for the CSV. The page stores this text behind every rounded number.
std::string CsvNumber(double value) { return fmt::format("{:.6g}", value); }

/// Returns the text in quotation marks, which RFC 4180 requires for commas.
std::string CsvText(const std::string& text) {
  std::string quoted(1, '"');
  for (const char c : text) quoted.append(c == '"' ? 2 : 1, c);
  quoted.push_back('"');
  return quoted;
}

/// Returns the text reduced to letters, digits and single dashes, for names of files and anchors.
std::string FileKey(const std::string& text) {
  std::string key;
  for (const char c : text) {
    const bool plain = IsLetterOrDigit(c);
    if (plain || (!key.empty() && key.back() != '-')) key += plain ? c : '-';
  }
  return key;
}

/// Returns "earth", "range, earth" or, if there is only a scene, "range".
std::string PlaceName(const ReportTopic& topic) {
  if (topic.scene.empty()) return topic.medium.name;
  return topic.medium.name.empty() ? topic.scene : topic.scene + ", " + topic.medium.name;
}

std::string TopicKey(const ReportTopic& topic) {
  return topic.key + "." + FileKey(PlaceName(topic));
}

/// Returns the hash of the atmosphere, if there is one.
std::string HashDigits(const ReportTopic& topic) {
  return topic.medium.name.empty() ? "" : fmt::format("{:016x}", MediumHash(topic.medium));
}

double CostOf(const ReportTopic& topic, const ReportRow& row, std::size_t regime) {
  return topic.cost == CostAxis::kTimeToBuild ? row.build_s : row.at[regime].time_s;
}

/// Returns one panel per regime, each with all series of the topic. `cost` returns the x value of a
/// row in a regime; a value that is not positive means that there is no point.
template <typename Cost>
std::vector<PlotPanel> PanelsOf(const ReportTopic& topic, const Cost& cost) {
  std::vector<PlotPanel> panels;
  for (std::size_t regime = 0; regime < topic.regimes.size(); ++regime) {
    std::vector<PlotSeries> list;
    for (const ReportRow& row : topic.rows) {
      auto series = std::find_if(list.begin(), list.end(),
                                 [&](const PlotSeries& one) { return one.name == row.series; });
      if (series == list.end())
        series = list.insert(series, {row.series, row.origin == MethodOrigin::kLiterature, {}});
      const double x = cost(row, regime);
      const ErrorStatistics& error = row.at[regime].error;
      if (x > 0.0 && row.at[regime].IsMeasured())
        series->points.push_back({x, error.Rms(), error.Quantile(0.99), row.parameter});
    }
    panels.push_back({topic.regimes[regime].name, std::move(list), {}});
  }
  return panels;
}

std::string PlotSubtitle(const ReportTopic& topic) {
  return fmt::format(
      "Atmosphere: {}. Marks: root mean square over {} {}s per panel, {} wavelength{}; "
      "thin lines: up to the 99th percentile. Lower left is better.",
      PlaceName(topic), topic.rays, topic.answer, topic.medium.wavelengths_nm.size(),
      topic.medium.wavelengths_nm.size() == 1 ? "" : "s");
}

/// Returns the plot over samples, which is independent of the processor's speed; nullopt if rows
/// have no samples.
std::optional<Plot> PlotOverSamples(const ReportTopic& topic) {
  const auto samples = [](const ReportRow& row, std::size_t regime) {
    return row.at[regime].samples;
  };
  const bool any = std::any_of(topic.rows.begin(), topic.rows.end(), [](const ReportRow& row) {
    return row.origin == MethodOrigin::kOurs && row.at[0].samples > 0.0;
  });
  if (!any || topic.cost == CostAxis::kTimeToBuild) return {};
  return Plot{topic.title,
              PlotSubtitle(topic),
              {"sampled points of the air, mean of the " + topic.answer + "s", PlotUnit::kCount},
              {"error", PlotUnit::kShare},
              PanelsOf(topic, samples)};
}

/// Returns the aerosol's optical depth at the wavelength nearest to 550 nm, in words.
std::string AerosolText(const Medium& medium) {
  std::size_t nearest = 0;
  const auto off = [&](std::size_t band) { return std::abs(medium.wavelengths_nm[band] - 550.0); };
  for (std::size_t band = 1; band < medium.wavelengths_nm.size(); ++band) {
    if (off(band) < off(nearest)) nearest = band;
  }
  return fmt::format("aerosol optical depth {:.2g} at {:.0f} nm",
                     medium.mie_extinction_per_m[nearest] * medium.mie_scale_height_m,
                     medium.wavelengths_nm[nearest]);
}

std::string MediumParagraph(const Medium& medium) {
  std::string wavelengths;
  for (const double nm : medium.wavelengths_nm)
    wavelengths += fmt::format("{}{:.0f}", wavelengths.empty() ? "" : ", ", nm);
  return fmt::format("{} (hash {:016x}): {}; wavelengths {} nm", medium.name, MediumHash(medium),
                     AerosolText(medium), wavelengths);
}

std::string ShareText(double value) { return QuantityText(value, PlotUnit::kShare); }
std::string TimeText(double seconds) { return QuantityText(seconds, PlotUnit::kSeconds); }
std::string MemoryText(std::uint64_t bytes) {
  return QuantityText(static_cast<double>(bytes), PlotUnit::kBytes);
}

/// Returns the rms and the percentile, and the strict rms if it differs.
std::string ErrorText(const RegimeResult& result) {
  const double rms = result.error.Rms(), strict = result.strict.Rms();
  return (result.error.RmsIsBound() ? "< " : "") + ShareText(rms) + " / " +
         ShareText(result.error.Quantile(0.99)) + (strict == rms ? "" : " / " + ShareText(strict));
}

/// Returns the time of an answer in the slowest regime.
double SlowestAnswer(const ReportRow& row) {
  double slowest = 0.0;
  for (const RegimeResult& result : row.at) slowest = std::max(slowest, result.time_s);
  return slowest;
}

double LargestPercentile99(const ReportRow& row) {
  double largest = 0.0;
  for (const RegimeResult& result : row.at)
    largest = std::max(largest, result.error.Quantile(0.99));
  return largest;
}

/// Returns the row of an origin with the least cost, of those that are measured in every regime
/// with 99th percentiles up to `wanted`; null if there is none.
const ReportRow* BestOf(const ReportTopic& topic, MethodOrigin origin, double wanted,
                        double (*cost)(const ReportRow&)) {
  const ReportRow* best = nullptr;
  for (const ReportRow& row : topic.rows) {
    if (row.origin != origin || LargestPercentile99(row) > wanted) continue;
    if (!std::all_of(row.at.begin(), row.at.end(),
                     [](const RegimeResult& result) { return result.IsMeasured(); }))
      continue;
    if (best == nullptr || cost(row) < cost(*best)) best = &row;
  }
  return best;
}

std::string CostText(const ReportTopic& topic, const ReportRow& row) {
  return TimeText(SlowestAnswer(row)) + " per " + topic.answer +
         (row.memory_bytes == 0 ? "" : ", " + MemoryText(row.memory_bytes)) +
         (row.build_s == 0.0 ? "" : ", ready in " + TimeText(row.build_s));
}

/// Summarises the results of a topic for one origin, in a sentence.
std::string FindingOf(const ReportTopic& topic, MethodOrigin origin) {
  if (const ReportRow* row = BestOf(topic, origin, topic.wanted, SlowestAnswer)) {
    return fmt::format("{}: {}. 99 of 100 errors below {} {}.", row->Name(), CostText(topic, *row),
                       ShareText(LargestPercentile99(*row)), topic.everywhere);
  }
  constexpr double kAny = std::numeric_limits<double>::infinity();
  const ReportRow* best = BestOf(topic, origin, kAny, LargestPercentile99);
  if (best == nullptr) return "No method was measured.";
  std::string parts;
  for (std::size_t r = 0; r < topic.regimes.size(); ++r)
    parts += fmt::format("{}{} {}", r == 0 ? "" : ", ", ShareText(best->at[r].error.Quantile(0.99)),
                         topic.regimes[r].key);
  return fmt::format("No method has 99 of 100 errors below {} {}. The most accurate is {} ({}): {}",
                     ShareText(topic.wanted), topic.everywhere, best->Name(),
                     CostText(topic, *best), parts);
}

/// Returns a cell of a table, with the number of the CSV file behind the rounded one.
std::string Cell(const std::string& csv, const std::string& text, const std::string& kind = "") {
  return fmt::format("<td{} data-csv=\"{}\">{}</td>",
                     kind.empty() ? "" : fmt::format(" class=\"{}\"", kind), csv, XmlText(text));
}

std::string ErrorCell(double error, const std::string& before = "") {
  constexpr std::array<double, 4> kEnds{1e-4, 1e-3, 1e-2, 1e-1};
  const auto shade = std::upper_bound(kEnds.begin(), kEnds.end(), error) - kEnds.begin();
  return Cell(CsvNumber(error), before + ShareText(error), fmt::format("e{}", shade));
}

std::string RegimeCells(const RegimeResult& result) {
  if (!result.IsMeasured()) return "<td class=\"first\"></td><td></td><td></td><td></td><td></td>";
  const ErrorStatistics& error = result.error;
  return Cell(CsvNumber(result.time_s), TimeText(result.time_s), "first") +
         ErrorCell(error.Rms(), error.RmsIsBound() ? "< " : "") + ErrorCell(error.Quantile(0.99)) +
         ErrorCell(error.Largest()) + ErrorCell(result.strict.Rms());
}

std::string TableRow(const ReportRow& row) {
  double spread = 0.0;
  for (const RegimeResult& result : row.at) spread = std::max(spread, result.time_spread);
  std::string text = fmt::format("<tr class=\"{}\"><th scope=\"row\">{}</th><td>{}</td>",
                                 row.origin == MethodOrigin::kOurs ? "ours" : "theirs",
                                 XmlText(row.series), XmlText(row.parameter));
  text += Cell(fmt::format("{}", row.memory_bytes),
               row.memory_bytes == 0 ? "–" : MemoryText(row.memory_bytes));
  text += Cell(CsvNumber(row.build_s), row.build_s == 0.0 ? "–" : TimeText(row.build_s));
  for (const RegimeResult& result : row.at) text += RegimeCells(result);
  return text + Cell(CsvNumber(spread), ShareText(spread), "first") + "</tr>\n";
}

std::string TableOf(const ReportTopic& topic) {
  std::string text =
      "<div class=\"wide\"><table>\n<thead><tr><th rowspan=\"2\">method</th><th "
      "rowspan=\"2\">size</th><th rowspan=\"2\">memory</th><th rowspan=\"2\">build</th>";
  for (const ReportRegime& regime : topic.regimes)
    text += fmt::format("<th colspan=\"5\" class=\"first\">{}</th>", regime.name);
  text += "<th rowspan=\"2\" class=\"first\">spread</th></tr>\n<tr>";
  for (std::size_t r = 0; r < topic.regimes.size(); ++r)
    text +=
        "<th class=\"first\">time</th><th>rms</th><th>99 %</th><th>max</th>"
        "<th>strict</th>";
  text += "</tr></thead>\n<tbody>\n";
  for (const ReportRow& row : topic.rows) text += TableRow(row);
  return text + "</tbody></table></div>\n";
}

std::string BiasText(double bias) { return fmt::format("{:+.1f} %", 100.0 * bias); }

std::string ValueText(double value, ReportUnit unit) {
  switch (unit) {
    case ReportUnit::kSeconds:
      return TimeText(value);
    case ReportUnit::kBytes:
      return QuantityText(value, PlotUnit::kBytes);
    case ReportUnit::kError:
      return ShareText(value);
    case ReportUnit::kBias:
      return BiasText(value);
  }
  return "";
}

/// Returns a value for people; `none` for costs of 0.
std::string ValueText(double value, ReportUnit unit, const char* none) {
  const bool is_cost = unit == ReportUnit::kSeconds || unit == ReportUnit::kBytes;
  return is_cost && value == 0.0 ? none : ValueText(value, unit);
}

std::string ValueCell(const std::optional<double>& value, ReportUnit unit) {
  if (!value) return "<td></td>";
  if (unit == ReportUnit::kError) return ErrorCell(*value);
  return Cell(CsvNumber(*value), ValueText(*value, unit, "–"));
}

std::string FurtherTableOf(const ReportTable& table) {
  std::string text = fmt::format(
      "<h4>{}</h4>\n<div class=\"wide\"><table>\n<thead><tr><th>method</th>", XmlText(table.title));
  for (const ReportColumn& column : table.columns)
    text += fmt::format("<th>{}</th>", XmlText(column.name));
  text += "</tr></thead>\n<tbody>\n";
  for (const ReportTable::Line& line : table.lines) {
    text +=
        fmt::format("<tr class=\"{}\"><th scope=\"row\">{}</th>",
                    line.origin == MethodOrigin::kOurs ? "ours" : "theirs", XmlText(line.method));
    for (std::size_t i = 0; i < table.columns.size(); ++i)
      text += ValueCell(line.values.at(i), table.columns[i].unit);
    text += "</tr>\n";
  }
  return text + "</tbody></table></div>\n";
}

std::string CsvOfTable(const ReportTable& table) {
  std::string text = "method,origin";
  for (const ReportColumn& column : table.columns) text.append(",").append(CsvText(column.name));
  text += "\n";
  for (const ReportTable::Line& line : table.lines) {
    text += CsvText(line.method) +
            (line.origin == MethodOrigin::kOurs ? ",this library" : ",literature");
    for (const std::optional<double>& value : line.values) {
      text += ',';
      if (value) text += CsvNumber(*value);
    }
    text += "\n";
  }
  return text;
}

/// Returns a further table in Markdown.
std::string SummaryOfTable(const ReportTable& table) {
  std::string text = fmt::format("**{}**.\n\n| method |", table.title);
  for (const ReportColumn& column : table.columns) text += fmt::format(" {} |", column.name);
  text += "\n|---|";
  for (std::size_t i = 0; i < table.columns.size(); ++i) text += "---|";
  for (const ReportTable::Line& line : table.lines) {
    text += fmt::format("\n| {} |", line.method);
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
      const std::optional<double>& value = line.values.at(i);
      text += value ? fmt::format(" {} |", ValueText(*value, table.columns[i].unit, "-")) : " |";
    }
  }
  return text + "\n\n";
}

/// Returns bytes in base 64 (RFC 4648).
std::string Base64Of(const std::string& bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - at);
    std::uint32_t word = 0;
    for (std::size_t i = 0; i < 3; ++i)
      word = word << 8U | (i < count ? static_cast<unsigned char>(bytes[at + i]) : 0U);
    for (std::size_t i = 0; i < 4; ++i)
      text += i <= count ? kDigits[word >> (18U - 6U * i) & 63U] : '=';
  }
  return text;
}

/// Returns the pictures of a topic, which are part of the page.
std::string PicturesOf(const ReportTopic& topic) {
  if (topic.pictures.empty()) return "";
  std::string text = "<div class=\"pictures\">\n";
  for (const ReportPicture& picture : topic.pictures) {
    text += fmt::format(
        "<figure><img width=\"{}\" height=\"{}\" alt=\"{}\" "
        "src=\"data:image/png;base64,{}\"><figcaption>{}</figcaption></figure>\n",
        picture.image.width, picture.image.height, XmlText(picture.caption),
        Base64Of(PngBytes(picture.image, {})), XmlText(picture.caption));
  }
  return text + "</div>\n";
}

std::string ReferenceText(const ReportTopic& topic) {
  const ReportReference& reference = topic.reference;
  std::string text = fmt::format("Reference solution: {}; {} per answer.", reference.text,
                                 TimeText(reference.time_s));
  if (reference.noise[0] == 0.0) return text;
  text += " Its standard error, rms:";
  for (std::size_t r = 0; r < topic.regimes.size(); ++r)
    text += fmt::format("{} {} {}", r == 0 ? "" : ",", ShareText(reference.noise[r]),
                        topic.regimes[r].key);
  return text +
         ". It is subtracted from the rms errors, but not from percentiles and maxima. Errors "
         "below half of it are not resolved.";
}

/// Returns a description of atmosphere and scene.
std::string PlaceText(const ReportTopic& topic) {
  if (topic.medium.name.empty()) return topic.scene;
  const std::string place = "Atmosphere " + topic.medium.name + ": " + AerosolText(topic.medium);
  return topic.scene.empty() ? place : topic.scene + "; " + place;
}

std::string SectionOf(const ReportTopic& topic) {
  std::string text =
      fmt::format("<section id=\"{}\">\n<h3>{}</h3>\n", TopicKey(topic), XmlText(PlaceText(topic)));
  text += fmt::format("<figure>{}</figure>\n", SvgOfPlot(PlotOfTopic(topic)));
  if (const auto plot = PlotOverSamples(topic)) {
    text +=
        "<details><summary>Errors over the number of samples, which does not depend on the "
        "machine</summary><figure>" +
        SvgOfPlot(*plot) + "</figure></details>\n";
  }
  text += TableOf(topic);
  for (const ReportTable& table : topic.tables) text += FurtherTableOf(table);
  text += PicturesOf(topic);
  return text +
         fmt::format("<p class=\"reference\">{}</p>\n</section>\n", XmlText(ReferenceText(topic)));
}

std::string CardsOf(const Report& report) {
  std::string text = "<div class=\"cards\">\n";
  for (const ReportTopic& topic : report.topics) {
    text += fmt::format(
        "<div class=\"card\"><h3><a href=\"#{}\">{}</a></h3><p class=\"air\">{}; wanted: 99 of "
        "100 errors below {}</p>\n"
        "<p><b>This library.</b> {}</p>\n<p><b>Literature.</b> {}</p></div>\n",
        TopicKey(topic), XmlText(topic.title.substr(0, topic.title.find(':'))),
        XmlText(PlaceName(topic)), ShareText(topic.wanted),
        XmlText(FindingOf(topic, MethodOrigin::kOurs)),
        XmlText(FindingOf(topic, MethodOrigin::kLiterature)));
  }
  return text + "</div>\n";
}

std::string MakerText(const Report& report) {
  const ReportMaker& maker = report.maker;
  std::string text = "<dl>\n";
  const auto add = [&](const char* name, const std::string& value) {
    text += fmt::format("<dt>{}</dt><dd>{}</dd>\n", name, XmlText(value));
  };
  add("machine", maker.machine);
  add("system", maker.system);
  add("program", maker.program);
  add("compiler", maker.compiler);
  add("date", maker.date);
  for (const ReportTopic& topic : report.topics) {
    if (topic.key == report.topics.front().key) add("atmosphere", MediumParagraph(topic.medium));
  }
  add("this report",
      fmt::format("took {:.0f} s, {:.0f} s of processor time{}", report.wall_s, report.cpu_s,
                  report.quick ? "; --quick: only a test of the report" : ""));
  return text + "</dl>\n";
}

std::string TopicsText(const Report& report) {
  std::string text, key;
  for (const ReportTopic& topic : report.topics) {
    if (topic.key != key) {
      text +=
          fmt::format("<h2>{}</h2>\n<p>{}</p>\n<p>Errors are {}. {}</p>\n", XmlText(topic.title),
                      XmlText(topic.what), XmlText(topic.error_unit), XmlText(topic.notes));
    }
    key = topic.key;
    text += SectionOf(topic);
  }
  return text;
}

void Replace(std::string& text, const std::string& place, const std::string& value) {
  std::size_t at = text.find(place);
  ALPENGLOW_ENSURE(at, !=, std::string::npos);
  for (; at != std::string::npos; at = text.find(place, at + value.size()))
    text.replace(at, place.size(), value);
}

std::string SummaryRow(const ReportRow& row) {
  std::string text =
      fmt::format("| {} | {} | {} | {} |", row.Name(),
                  row.memory_bytes == 0 ? "-" : MemoryText(row.memory_bytes),
                  row.build_s == 0.0 ? "-" : TimeText(row.build_s), TimeText(SlowestAnswer(row)));
  for (const RegimeResult& result : row.at) {
    text += result.IsMeasured() ? fmt::format(" {} |", ErrorText(result)) : " |";
  }
  return text + "\n";
}

}  // namespace

Plot PlotOfTopic(const ReportTopic& topic) {
  const bool build = topic.cost == CostAxis::kTimeToBuild;
  Plot plot{
      topic.title,
      PlotSubtitle(topic),
      {build ? "time to build, all threads" : "time of one answer, one thread", PlotUnit::kSeconds},
      {"error", PlotUnit::kShare},
      PanelsOf(topic, [&](const ReportRow& row, std::size_t regime) {
        return CostOf(topic, row, regime);
      })};
  for (std::size_t regime = 0; regime < topic.regimes.size(); ++regime) {
    for (const ReportRow& row : topic.rows) {
      if (row.at[regime].IsMeasured() && !(CostOf(topic, row, regime) > 0.0))
        plot.panels[regime].levels.push_back({row.Name(), row.at[regime].error.Rms()});
    }
  }
  return plot;
}

std::string CsvHeader() {
  return "topic,scene,atmosphere,atmosphere_hash,series,parameter,origin,memory_bytes,build_s,"
         "regime,"
         "sun_low_deg,sun_high_deg,rays,samples,time_s,time_spread,error_median,error_rms,"
         "error_rms_is_bound,error_99,error_max,error_strict_rms,error_strict_99,reference_noise,"
         "machine,made_by,date\n";
}

std::string CsvOfTopic(const ReportTopic& topic, const ReportMaker& maker) {
  std::string text;
  for (const ReportRow& row : topic.rows) {
    for (std::size_t r = 0; r < topic.regimes.size(); ++r) {
      const auto& [error, strict, time_s, time_spread, samples] = row.at[r];
      if (!row.at[r].IsMeasured()) continue;
      const std::optional<SunRange>& sun = topic.regimes[r].sun;
      const std::vector<std::string> method{
          topic.key,
          topic.scene.empty() ? "" : CsvText(topic.scene),
          CsvText(topic.medium.name),
          HashDigits(topic),
          CsvText(row.series),
          CsvText(row.parameter),
          row.origin == MethodOrigin::kOurs ? "this library" : "literature",
          fmt::format("{}", row.memory_bytes),
          CsvNumber(row.build_s),
          topic.regimes[r].key,
          sun ? fmt::format("{},{}", sun->lowest_deg, sun->highest_deg) : ",",
          fmt::format("{}", topic.rays)};
      const std::array<double, 11> numbers{samples,
                                           time_s,
                                           time_spread,
                                           error.Quantile(0.5),
                                           error.Rms(),
                                           error.RmsIsBound() ? 1.0 : 0.0,
                                           error.Quantile(0.99),
                                           error.Largest(),
                                           strict.Rms(),
                                           strict.Quantile(0.99),
                                           topic.reference.noise[r]};
      text += fmt::format("{},{:.6g},{},{},{}\n", fmt::join(method, ","), fmt::join(numbers, ","),
                          CsvText(maker.machine), CsvText(maker.program), CsvText(maker.date));
    }
  }
  return text;
}

std::string SummaryOf(const Report& report) {
  std::string text;
  for (const ReportTopic& topic : report.topics) {
    text += fmt::format(
        "**{}**. {}; {} {}s per column; error: rms / 99th percentile "
        "(/ rms relative to each value, however dark)\n\n",
        topic.title.substr(0, topic.title.find(':')), PlaceText(topic), topic.rays, topic.answer);
    text += fmt::format("| method | memory | build | time per {} |", topic.answer);
    for (const ReportRegime& regime : topic.regimes) text += fmt::format(" {} |", regime.name);
    text += "\n|---|---|---|---|";
    for (std::size_t r = 0; r < topic.regimes.size(); ++r) text += "---|";
    text += "\n";
    for (const ReportRow& row : topic.rows) {
      if (row.in_summary) text += SummaryRow(row);
    }
    if (topic.reference.noise[0] > 0.0) text += fmt::format("\n{}\n", ReferenceText(topic));
    text += "\n";
    for (const ReportTable& table : topic.tables) text += SummaryOfTable(table);
  }
  return text + fmt::format("{}; {}; {}; {}.\n", report.maker.machine, report.maker.program,
                            report.maker.compiler, report.maker.date);
}

std::string PageOf(const Report& report) {
  std::string page(lut_report::EmbeddedText("lut/report/report_page.html"));
  Replace(page, "@title@", XmlText(report.words.title));
  Replace(page, "@lead@", XmlText(report.words.lead));
  Replace(page, "@minute@", XmlText(report.words.minute));
  Replace(page, "@reading@", XmlText(report.words.reading));
  Replace(page, "@findings@", CardsOf(report));
  Replace(page, "@maker@", MakerText(report));
  Replace(page, "@topics@", TopicsText(report));
  return page;
}

void WriteReport(const Report& report, const fs::path& folder) {
  MakeFolder(folder);
  std::map<std::string, std::string> tables;
  for (const ReportTopic& topic : report.topics) {
    std::string& table = tables.try_emplace(topic.key, CsvHeader()).first->second;
    table += CsvOfTopic(topic, report.maker);
    WriteTextAtomically(folder / (TopicKey(topic) + ".svg"), SvgOfPlot(PlotOfTopic(topic)));
    if (const auto plot = PlotOverSamples(topic))
      WriteTextAtomically(folder / (TopicKey(topic) + ".samples.svg"), SvgOfPlot(*plot));
    for (const ReportTable& one : topic.tables)
      WriteTextAtomically(folder / (TopicKey(topic) + "." + one.key + ".csv"), CsvOfTable(one));
    for (const ReportPicture& picture : topic.pictures)
      WritePng(folder / (TopicKey(topic) + "." + picture.key + ".png"), picture.image, {});
  }
  for (const auto& [key, table] : tables) WriteTextAtomically(folder / (key + ".csv"), table);
  WriteTextAtomically(folder / "summary.md", SummaryOf(report));
  WriteTextAtomically(folder / "index.html", PageOf(report));
}

}  // namespace alpenglow::lut
