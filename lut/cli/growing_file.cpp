// SPDX-License-Identifier: MIT
#include "lut/cli/growing_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "atmosphere/base/error.h"
#include "lut/layer.h"

namespace alpenglow::lut {
namespace {

namespace fs = std::filesystem;

bool Lock(int file) {
  int status = -1;
  do {
    status = flock(file, LOCK_EX | LOCK_NB);
  } while (status != 0 && errno == EINTR);
  return status == 0 || errno != EWOULDBLOCK;  // file systems without locks: one writer
}

}  // namespace

fs::path GrowingFile::PartOf(const fs::path& target) { return target.string() + ".part"; }

GrowingFile::GrowingFile(const fs::path& target)
    : target_(FinalName(target)), part_(PartOf(target_)) {
  Open();
  if (bytes_ > 0) KeepAside();
}

GrowingFile::~GrowingFile() {
  std::error_code ignored;
  if (bytes_ == 0 && IsOurs()) fs::remove(part_, ignored);
}

void GrowingFile::Fail(const std::string& fault) const {
  throw OutputError(fmt::format("{}: {}", part_.string(), fault));
}

// Opens and locks the file, and keeps its content.
void GrowingFile::Open() {
  do {
    file_ = Descriptor(open(part_.c_str(), O_CREAT | O_WRONLY | O_APPEND | O_CLOEXEC, 0666));
    if (!file_.valid()) Fail("cannot be written: " + LastSystemError());
    if (!Lock(file_.number())) Fail("is being written by another process");
  } while (!IsOurs());  // its writer renamed it before it was locked
  struct stat status = {};
  fstat(file_.number(), &status);
  bytes_ = status.st_size;
}

// Returns whether the name still belongs to the open file.
bool GrowingFile::IsOurs() const {
  struct stat opened = {}, named = {};
  return fstat(file_.number(), &opened) == 0 && stat(part_.c_str(), &named) == 0 &&
         opened.st_ino == named.st_ino && opened.st_dev == named.st_dev;
}

void GrowingFile::KeepAside() {
  int number = 1;
  const auto aside = [&] { return fs::path(fmt::format("{}.{}.part", target_.string(), number)); };
  while (fs::exists(aside())) ++number;
  std::error_code error;
  fs::rename(part_, aside(), error);
  if (error) Fail("cannot be kept under another name: " + error.message());
  kept_ = aside();
  Open();
}

void GrowingFile::Append(std::string_view lines) {
  std::size_t written = 0;
  while (written < lines.size()) {
    const ssize_t count = write(file_.number(), lines.data() + written, lines.size() - written);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) {
      const std::string fault = LastSystemError();
      static_cast<void>(!ftruncate(file_.number(), bytes_));  // removes an incomplete line
      Fail("cannot be written: " + fault);
    }
    written += static_cast<std::size_t>(count);
  }
  bytes_ += static_cast<long long>(lines.size());
}

void GrowingFile::Sync() const noexcept { static_cast<void>(!fdatasync(file_.number())); }

void GrowingFile::Finish() {
  if (bytes_ == 0) return;
  if (fsync(file_.number()) != 0) Fail("cannot be written: " + LastSystemError());
  std::error_code error;
  fs::rename(part_, target_, error);
  if (error) Fail(fmt::format("cannot be renamed to {}: {}", target_.string(), error.message()));
}

}  // namespace alpenglow::lut
