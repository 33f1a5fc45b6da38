// SPDX-License-Identifier: MIT
#include "lut/table_io/table_file.h"

#include <OpenEXR/ImfArray.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfTiledOutputFile.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/medium/atmosphere_file.h"
#include "atmosphere/medium/medium.h"
#include "lut/table_io/table_image.h"
#include "tests/fixtures/fault_of.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow::lut {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const TransmittanceTable& Transmittance() {
  static const TransmittanceTable table(MediumPreset("bruneton2017"), {.mu = 8, .altitudes = 4});
  return table;
}

const ScatteringTable& Scattering() {
  static const ScatteringTable table(
      MediumPreset("bruneton2017"),
      {.size = {.nu = 2, .mu_s = 4, .mu = 8, .altitudes = 3}, .lowest_mu_s = {}});
  return table;
}

class TableFile : public TemporaryFolder {
 protected:
  void SetUp() override {
    TemporaryFolder::SetUp();
    good_ = folder_ / "good.exr";
    bad_ = folder_ / "bad.exr";
    WriteTable(good_, Transmittance());
  }

  /// Returns the header of a good file, with its channels and attributes.
  [[nodiscard]] Imf::Header GoodHeader() const { return Imf::InputFile(good_.c_str()).header(); }

  /// Returns a header of the good size with every attribute of the program but one, and no
  /// channels. (Imf::Header::erase leaks.)
  [[nodiscard]] Imf::Header HeaderWithout(const std::string& name) const {
    const Imf::Header good = GoodHeader();
    Imf::Header header(8, 4);
    for (auto attribute = good.begin(); attribute != good.end(); ++attribute) {
      if (attribute.name() != name && std::strncmp(attribute.name(), "alpenglow.", 10) == 0) {
        header.insert(attribute.name(), attribute.attribute());
      }
    }
    return header;
  }

  /// Writes `value` under a header, in every channel by its own type.
  void WriteImage(const Imf::Header& header, float value = 0.5F) const {
    const auto window = header.dataWindow();
    const auto width = static_cast<std::size_t>(window.max.x - window.min.x + 1);
    const auto height = static_cast<std::size_t>(window.max.y - window.min.y + 1);
    std::vector<float> floats(width * height, value);
    std::vector<half> halves(width * height, half(value));
    Imf::FrameBuffer buffer;
    for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel) {
      const bool is_half = channel.channel().type == Imf::HALF;
      const std::size_t size = is_half ? sizeof(half) : sizeof(float);
      const std::size_t origin =
          static_cast<std::size_t>(window.min.y) * width + static_cast<std::size_t>(window.min.x);
      char* base =
          is_half ? reinterpret_cast<char*>(halves.data()) : reinterpret_cast<char*>(floats.data());
      buffer.insert(channel.name(),
                    Imf::Slice(channel.channel().type, base - origin * size, size, size * width));
    }
    Imf::OutputFile file(bad_.c_str(), header);
    file.setFrameBuffer(buffer);
    file.writePixels(static_cast<int>(height));
  }

  void ExpectRefused(const std::string& reason) const {
    tests::ExpectNames(tests::FaultOf([&] { return ReadTransmittanceTable(bad_); }), bad_, reason);
  }

  fs::path good_, bad_;
};

TEST_F(TableFile, TransmittanceKeepsEveryBit) {
  const TransmittanceTable back = ReadTransmittanceTable(good_);
  EXPECT_EQ(back.texels(), Transmittance().texels());
  EXPECT_EQ(back.size().mu, 8U);
  EXPECT_EQ(back.size().altitudes, 4U);
  EXPECT_EQ(back.medium(), Transmittance().medium()) << "every parameter and the name";
  WriteTable(bad_, Transmittance());
  EXPECT_EQ(ContentOf(bad_), ContentOf(good_));
}

TEST_F(TableFile, SingleScatteringKeepsEveryBit) {
  const fs::path file = folder_ / "scattering.exr";
  WriteTable(file, Scattering());
  const ScatteringTable back = ReadScatteringTable(file, MediumHash(Scattering().medium()));
  EXPECT_EQ(back.texels(), Scattering().texels());
  EXPECT_EQ(back.lowest_mu_s(), Scattering().lowest_mu_s());
  const ViewRay ray = RayFromAngles(3000.0, 70.0, 40.0, 60.0);
  EXPECT_EQ(back.Lookup(ray).rayleigh[1], Scattering().Lookup(ray).rayleigh[1]);
}

TEST_F(TableFile, SingleScatteringByAzimuthKeepsItsAxes) {
  const ScatteringTable table(MediumPreset("bruneton2017"),
                              {.size = {.nu = 3, .mu_s = 4, .mu = 8, .altitudes = 5},
                               .lowest_mu_s = {},
                               .axes = ScatteringAxes::kAzimuth});
  const fs::path file = folder_ / "scattering.exr";
  WriteTable(file, table);
  const ScatteringTable back = ReadScatteringTable(file);
  EXPECT_EQ(back.axes(), ScatteringAxes::kAzimuth);
  EXPECT_EQ(back.texels(), table.texels());
  EXPECT_THAT(DescriptionText(file, DescribeTable(file)), HasSubstr("mu_s azimuth mu r"));
}

const MultipleScattering& Light() {
  static const MultipleScattering light(MediumPreset("bruneton2017"), {.altitudes = 5,
                                                                       .sun_angles = 6,
                                                                       .degree = 2,
                                                                       .zenith_nodes = 4,
                                                                       .azimuth_nodes = 4,
                                                                       .ray_nodes = 4});
  return light;
}

TEST_F(TableFile, MultipleScatteringKeepsEveryBit) {
  const fs::path file = folder_ / "multiple.exr";
  const FolderUse use{.ray_nodes = 9, .transmittance = false, .single_scattering = true};
  WriteTable(file, Light(), use);
  const StoredMultipleScattering back = ReadMultipleScattering(file, MediumHash(Light().medium()));
  EXPECT_EQ(back.use, use);
  EXPECT_EQ(back.light.values(), Light().values());
  EXPECT_EQ(back.light.orders(), Light().orders());
  EXPECT_EQ(back.light.converged(), Light().converged());
  EXPECT_EQ(back.light.options().degree, 2);
  EXPECT_EQ(back.light.SkyIrradiance(700.0, 0.2), Light().SkyIrradiance(700.0, 0.2));
  const std::string text = DescriptionText(file, DescribeTable(file));
  for (const char* fact : {"multiple scattering", "L22.0550nm", "E.0680nm", "6 5 = 2520 bytes",
                           "every texel is finite and in [-100, 100]"}) {
    EXPECT_THAT(text, HasSubstr(fact));
  }
}

TEST_F(TableFile, PolarisedLightIsKeptAndNeverReadAsScalar) {
  const fs::path file = folder_ / "polarised.exr";
  const MultipleScattering light(InPolarisedLight(Light().medium(), "bruneton2017"),
                                 Light().options());
  WriteTable(file, light);
  const StoredMultipleScattering back = ReadMultipleScattering(file, MediumHash(light.medium()));
  EXPECT_EQ(back.light.values(), light.values());
  EXPECT_TRUE(back.light.medium().polarised);
  const std::string text = DescriptionText(file, DescribeTable(file));
  EXPECT_THAT(text, HasSubstr("T22.0550nm"));
  EXPECT_THROW(static_cast<void>(ReadMultipleScattering(file, MediumHash(Light().medium()))),
               InputError);
  const fs::path scalar = folder_ / "scalar.exr";
  WriteTable(scalar, Light());
  EXPECT_THROW(static_cast<void>(ReadMultipleScattering(scalar, MediumHash(light.medium()))),
               InputError);
}

TEST_F(TableFile, MultipleScatteringWithOtherAttributesIsRefused) {
  const fs::path file = folder_ / "multiple.exr";
  WriteTable(file, Light());
  EXPECT_THROW(static_cast<void>(ReadMultipleScattering(file, MediumHash(MediumPreset("earth")))),
               InputError);
  EXPECT_THROW(static_cast<void>(ReadTransmittanceTable(file)), InputError);
  const Imf::Header header = Imf::InputFile(file.c_str()).header();
  for (const auto& [name, text] : {std::pair{"alpenglow.degree", "4"},
                                   {"alpenglow.degree", "2.5"},
                                   {"alpenglow.orders", "0"},
                                   {"alpenglow.converged", "perhaps"},
                                   {"alpenglow.rayNodes", "99"},
                                   {"alpenglow.tables", "all"},
                                   {"alpenglow.sunCosines", "0 1"},
                                   {"alpenglow.mapVersion", "1"},
                                   {"alpenglow.axisSizes", "6 7"}}) {
    Imf::Header changed = header;
    changed.insert(name, Imf::StringAttribute(text));
    WriteImage(changed);
    EXPECT_THROW(static_cast<void>(ReadMultipleScattering(bad_)), InputError)
        << name << " = " << text;
  }
  Imf::Header of_before = header;
  of_before.insert("alpenglow.mapVersion", Imf::StringAttribute("1"));
  WriteImage(of_before);
  EXPECT_THAT(tests::FaultOf([&] { return ReadMultipleScattering(bad_); }),
              HasSubstr("alpenglow.mapVersion is 1; this program reads 2: build the tables again"));
  for (const std::string degree : {"0", "3", "5", "7"}) {
    Imf::Header changed = header;
    changed.insert("alpenglow.degree", Imf::StringAttribute(degree));
    WriteImage(changed);
    EXPECT_THAT(tests::FaultOf([&] { return ReadMultipleScattering(bad_); }),
                testing::AllOf(HasSubstr(bad_.string()),
                               HasSubstr("degree is " + degree + "; there are 2, 4, 6, 8, 12")));
  }
}

TEST_F(TableFile, ChannelsAndAttributesDescribeTheContent) {
  const fs::path file = folder_ / "scattering.exr";
  WriteTable(file, Scattering());
  const Imf::InputFile image(file.c_str());
  for (const char* name : {"rayleigh.0440nm", "rayleigh.0550nm", "rayleigh.0680nm", "mie.0440nm"}) {
    EXPECT_NE(image.header().channels().findChannel(name), nullptr) << name;
  }
  const TableImageReader reader(file);
  EXPECT_EQ(reader.Attribute("alpenglow.kind"), "single scattering");
  EXPECT_EQ(reader.Attribute("alpenglow.axes"), "mu_s nu mu r");
  EXPECT_EQ(reader.Attribute("alpenglow.axisSizes"), "4 2 8 3");
  EXPECT_EQ(reader.width(), 8U);
  EXPECT_EQ(reader.height(), 24U);
  EXPECT_THAT(reader.Attribute("alpenglow.producer"), HasSubstr("alpenglow "));
  EXPECT_THAT(reader.Attribute("alpenglow.medium"), HasSubstr("cornette-shanks"));
  EXPECT_EQ(reader.Attribute("alpenglow.mediumHash"),
            fmt::format("{:016x}", MediumHash(Scattering().medium())));
}

TEST_F(TableFile, EveryMediumSurvivesARoundTripThroughText) {
  std::vector<Medium> media;
  for (const std::string& name : MediumPresetNames()) media.push_back(MediumPreset(name));
  media.push_back(MediumFromToml("[aerosol]\nmixture = \"desert\"\n", "dusty"));
  for (const PhaseFunction& phase :
       {PhaseFunction{.kind = PhaseKind::kDoubleHenyeyGreenstein,
       .g = 0.7,
       .g_back = -0.3,
       .back_weight = 0.1},
        PhaseFunction{.kind = PhaseKind::kDraine, .g = 0.7, .alpha = 1.0 / 3.0},
        DropletPhase(10.0)}) {
    media.push_back(MediumPreset("earth"));
    media.back().mie_phase = {phase};
  }
  media.push_back(MediumPreset("earth"));
  media.back().mie_phase.assign(4, {.kind = PhaseKind::kDraine, .g = 0.7, .alpha = 1.0 / 3.0});
  media.back().mie_phase[2].g = 0.71;
  for (const Medium& medium : media) {
    EXPECT_EQ(MediumHash(MediumFromToml(TomlFromMedium(medium), medium.name)), MediumHash(medium))
        << medium.name;
  }
}

TEST_F(TableFile, FractionalWavelengthsHaveTheirOwnChannels) {
  const Medium medium = MediumPreset("earth", {450.25, 450.75, 600.0});
  const TransmittanceTable table(medium, {.mu = 2, .altitudes = 2});
  WriteTable(bad_, table);
  EXPECT_NE(Imf::InputFile(bad_.c_str()).header().channels().findChannel("T.0450,250nm"), nullptr);
  EXPECT_EQ(ReadTransmittanceTable(bad_).texels(), table.texels());
  EXPECT_THROW(WriteTable(bad_, TransmittanceTable(MediumPreset("earth", {450.0, 450.0001}),
                                                   {.mu = 2, .altitudes = 2})),
               InputError);
}

TEST_F(TableFile, DescriptionNamesSizesUnitsRangesAndMaker) {
  const TableDescription description = DescribeTable(good_);
  EXPECT_EQ(description.kind, "transmittance");
  EXPECT_EQ(description.channels.size(), 3U);
  EXPECT_EQ(description.channels[0].highest, 1.0) << "the top row";
  EXPECT_GT(description.channels[2].lowest, 0.0) << "red light on the horizon";
  const std::string text = DescriptionText(good_, description);
  for (const char* fact : {"mu r", "8 4", "alpenglow ", "bruneton2017", "T.0440nm", "384 bytes"}) {
    EXPECT_THAT(text, HasSubstr(fact));
  }
}

TEST_F(TableFile, EveryTruncationOfAValidFileIsRefused) {
  for (const bool scattering : {false, true}) {
    if (scattering) WriteTable(good_, Scattering());
    const std::string whole = ContentOf(good_);
    ASSERT_GT(whole.size(), 1000U);
    for (std::size_t size = 0; size < whole.size(); size += 64) {
      WriteText(bad_, whole.substr(0, size));
      EXPECT_THROW(static_cast<void>(DescribeTable(bad_)), InputError) << size;
    }
    WriteText(bad_, whole.substr(0, whole.size() - 1));
    EXPECT_THROW(static_cast<void>(DescribeTable(bad_)), InputError) << "one byte short";
  }
}

TEST_F(TableFile, FlippedBytesAreRefusedOrHarmless) {
  const std::string whole = ContentOf(good_);
  for (std::size_t at = 0; at < whole.size(); at += 7) {
    std::string flipped = whole;
    flipped[at] = static_cast<char>(flipped[at] ^ 0x55);
    WriteText(bad_, flipped);
    try {
      const TransmittanceTable table = ReadTransmittanceTable(bad_);
      EXPECT_EQ(MediumHash(table.medium()), MediumHash(Transmittance().medium())) << at;
      for (const float value : table.texels()) ASSERT_TRUE(value >= 0.0F && value <= 1.0F) << at;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(bad_.string())) << at;
    }
  }
}

TEST_F(TableFile, MissingFilesAndFoldersAreRefused) {
  ExpectRefused("");
  fs::create_directory(bad_);
  ExpectRefused("is not a regular file");
  fs::remove(bad_);
  WriteText(bad_, "");
  ExpectRefused("is not an OpenEXR file");
  WriteText(bad_, "id,quantity\n");
  ExpectRefused("is not an OpenEXR file");
}

TEST_F(TableFile, EveryAttributeIsRequired) {
  for (const char* name : {"kind", "quantity", "units", "axes", "axisSizes", "layout", "mapVersion",
                           "mediumHash", "mediumName", "medium", "producer"}) {
    Imf::Header header = HeaderWithout(fmt::format("alpenglow.{}", name));
    header.channels() = GoodHeader().channels();
    WriteImage(header);
    ExpectRefused(fmt::format("alpenglow.{}", name));
  }
}

TEST_F(TableFile, ContradictingAttributesAreRefused) {
  const std::pair<const char*, const char*> changes[] = {
      {"kind", "irradiance"},    {"units", "W"},
      {"axes", "r mu"},          {"mapVersion", "2"},
      {"mediumHash", "0"},       {"medium", "[planet]\nradius_m = -1"},
      {"axisSizes", "4 8"},      {"axisSizes", "8"},
      {"axisSizes", "8 4 2"},    {"axisSizes", "8 -4"},
      {"axisSizes", "8 4e9"},    {"axisSizes", "99999999999999999999 4"},
      {"axisSizes", "0 0"},      {"axisSizes", ""},
      {"layout", "upside down"}, {"quantity", "optical depth"},
  };
  for (const auto& [name, text] : changes) {
    Imf::Header header = GoodHeader();
    header.insert(fmt::format("alpenglow.{}", name), Imf::StringAttribute(text));
    WriteImage(header);
    ExpectRefused("");
  }
}

TEST_F(TableFile, ATableOfAnotherKindOrAtmosphereIsRefused) {
  WriteTable(bad_, Scattering());
  ExpectRefused("is a table of single scattering");
  EXPECT_THROW(static_cast<void>(ReadScatteringTable(good_)), InputError);
  EXPECT_THAT(tests::FaultOf(
                  [&] { return ReadTransmittanceTable(good_, MediumHash(MediumPreset("earth"))); }),
              HasSubstr("another atmosphere"));
}

TEST_F(TableFile, OtherImagesAreRefused) {
  const auto refuse = [&](Imf::Header header, const auto& change, const char* reason) {
    change(header);
    WriteImage(header);
    ExpectRefused(reason);
  };
  const Imf::Channel wide(Imf::FLOAT);
  refuse(
      Imf::Header(8, 4), [&](Imf::Header& h) { h.channels().insert("R", wide); },
      "is not a table of this program");
  refuse(
      HeaderWithout(""),
      [&](Imf::Header& h) {
        h.channels().insert("T.0440nm", wide);
        h.channels().insert("T.0680nm", wide);
      },
      "channel T.0550nm is missing");
  refuse(
      GoodHeader(), [&](Imf::Header& h) { h.channels().insert("A", wide); }, "has 4 channels");
  refuse(
      GoodHeader(),
      [](Imf::Header& h) { h.channels().insert("T.0550nm", Imf::Channel(Imf::HALF)); },
      "channel T.0550nm is not 32-bit float");
  refuse(
      GoodHeader(), [](Imf::Header& h) { h.dataWindow().max.x = 8; },
      "is 9 x 4 texels; its axes need 8 x 4");
  refuse(
      GoodHeader(),
      [](Imf::Header& h) {
        h.dataWindow() = Imath::Box2i({10, 20}, {17, 23});
      },
      "data window");
}

/// Returns where the value of the attribute is in the bytes of an image.
std::size_t DataWindowIn(const std::string& bytes) {
  return bytes.find("dataWindow") + std::strlen("dataWindow") + 1 + std::strlen("box2i") + 1 + 4;
}

TEST_F(TableFile, HugeDataWindowsAreRefusedBeforeAllocation) {
  std::string bytes = ContentOf(good_);
  for (const std::int32_t side : {65535, 1 << 19, 1 << 25, 2147483646}) {
    std::memcpy(&bytes[DataWindowIn(bytes) + 8], &side, 4);
    std::memcpy(&bytes[DataWindowIn(bytes) + 12], &side, 4);
    WriteText(bad_, bytes);
    ExpectRefused("");
  }
  // The axes claim more than the file can hold.
  Imf::Header header = GoodHeader();
  header.dataWindow().max = {4095, 1};
  header.insert("alpenglow.axisSizes", Imf::StringAttribute("4096 60000"));
  WriteImage(header);
  bytes = ContentOf(bad_);
  const std::int32_t last = 59999;
  std::memcpy(&bytes[DataWindowIn(bytes) + 12], &last, 4);
  WriteText(bad_, bytes);
  ExpectRefused("");
}

/// Returns the largest memory that a process had which read the file [kB].
long PeakOfReading(const fs::path& file) {
  const pid_t child = fork();
  if (child == 0) {
    try {
      static_cast<void>(DescribeTable(file));
    } catch (const InputError&) {
      // The file must be refused.
    }
    _exit(0);
  }
  int status = 0;
  rusage used = {};
  wait4(child, &status, 0, &used);
  return used.ru_maxrss;
}

// The library would take what an attribute claims: 1.9 GB for a table of 46 kB.
TEST_F(TableFile, AttributesLongerThanTheFileAllocateNoMemory) {
  const std::string whole = ContentOf(good_);
  for (const char* attribute : {"alpenglow.medium", "alpenglow.producer", "channels"}) {
    std::string bytes = whole;
    const std::size_t name = bytes.find(std::string(attribute) + '\0');
    ASSERT_NE(name, std::string::npos);
    const std::size_t type = bytes.find('\0', name) + 1;
    const std::size_t size = bytes.find('\0', type) + 1;
    for (const std::uint32_t claim : {0x7fffff00U, 0xffffffffU, 100000000U}) {
      std::memcpy(&bytes[size], &claim, 4);
      WriteText(bad_, bytes);
      ExpectRefused(fmt::format("attribute {} claims {} bytes", attribute, claim));
      EXPECT_LT(PeakOfReading(bad_), PeakOfReading(good_) + 20000) << "kB, " << attribute;
    }
  }
}

// The library decompresses sixteen rows together, and takes memory for them though the image has
// two: 65536 texels of 40 channels are 10 MB a row, zeros of which are 10 kB in the file.
TEST_F(TableFile, VeryWideRowsAllocateNoMemory) {
  std::vector<double> wavelengths_nm;
  for (int i = 0; i < 40; ++i) wavelengths_nm.push_back(400.0 + 7.0 * i);
  WriteTable(good_,
             TransmittanceTable(MediumPreset("earth", wavelengths_nm), {.mu = 8, .altitudes = 4}));
  Imf::Header header = HeaderWithout("");
  header.dataWindow().max = {65535, 1};
  header.displayWindow() = header.dataWindow();
  header.channels() = GoodHeader().channels();
  header.compression() = Imf::ZIP_COMPRESSION;
  header.insert("alpenglow.axisSizes", Imf::StringAttribute("65536 2"));
  WriteImage(header, 0.0F);
  ASSERT_LT(fs::file_size(bad_), 100000U);
  ExpectRefused("more than it can hold");
}

TEST_F(TableFile, TexelsOutsideZeroToOneAreRefusedWithTheirPlace) {
  for (const float value : {NAN, -1e-6F, 1.001F, INFINITY}) {
    WriteImage(GoodHeader(), value);
    ExpectRefused("texel (0, 0) of channel T.0440nm");
  }
}

TEST_F(TableFile, ATiledImageIsRefused) {
  Imf::Header header = GoodHeader();
  header.setTileDescription(Imf::TileDescription(8, 4));
  {
    std::vector<float> texels(32, 0.5F);
    Imf::FrameBuffer buffer;
    for (const char* name : {"T.0440nm", "T.0550nm", "T.0680nm"}) {
      buffer.insert(name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(texels.data()), 4, 32));
    }
    Imf::TiledOutputFile file(bad_.c_str(), header);
    file.setFrameBuffer(buffer);
    file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
  }
  ExpectRefused("is tiled");
}

TEST_F(TableFile, AnImageOfSeveralPartsIsRefused) {
  std::vector<Imf::Header> headers(2, GoodHeader());
  headers[0].setName("a");
  headers[1].setName("b");
  for (Imf::Header& header : headers) header.setType(Imf::SCANLINEIMAGE);
  {
    std::vector<float> texels(32, 0.5F);
    Imf::MultiPartOutputFile file(bad_.c_str(), headers.data(), 2);
    for (int i = 0; i < 2; ++i) {
      Imf::FrameBuffer buffer;
      for (const char* name : {"T.0440nm", "T.0550nm", "T.0680nm"}) {
        buffer.insert(name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(texels.data()), 4, 32));
      }
      Imf::OutputPart part(file, i);
      part.setFrameBuffer(buffer);
      part.writePixels(4);
    }
  }
  ExpectRefused("has 2 parts");
}

TEST_F(TableFile, ImpossibleLowestSunsAreRefused) {
  for (const char* text : {"0.5", "nan", "-2", "", "-0.3x"}) {
    WriteTable(good_, Scattering());
    Imf::Header header = GoodHeader();
    header.insert("alpenglow.lowestMuS", Imf::StringAttribute(text));
    WriteImage(header);
    EXPECT_THROW(static_cast<void>(ReadScatteringTable(bad_)), InputError) << text;
  }
}

TEST_F(TableFile, AMissingFolderIsAnOutputErrorThatNamesTheFile) {
  const fs::path file = folder_ / "missing" / "t.exr";
  EXPECT_THAT(tests::FaultOf<OutputError>([&] { WriteTable(file, Transmittance()); }),
              HasSubstr(file.string()));
}

}  // namespace
}  // namespace alpenglow::lut
