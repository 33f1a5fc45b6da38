// SPDX-License-Identifier: MIT
// The outputs of a program together, checked and prepared before its work.
#pragma once

#include <vector>

#include "lut/cli/output_file.h"

namespace alpenglow::lut {

/// Throws OptionError if two of the outputs are one file, whatever their names are: links, "..", or
/// relative and absolute paths.
void RequireDifferent(const std::vector<NamedFile>& outputs);

/// Prepares the outputs of a program: none is an input (InputError) or another output
/// (OptionError), their folders are made, and each file can be written (OutputError).
void PrepareOutputs(const std::vector<NamedFile>& outputs, const std::vector<NamedFile>& inputs);

}  // namespace alpenglow::lut
