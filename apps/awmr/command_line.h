/// What is wrong with a command line, in words.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace awmr::cli {

/// "; did you mean 'NAME'?" with the nearest of the names; empty where none is near.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& names);

/// What CLI11 says of the command line; of a command or an option that there is not, its name and
/// the nearest one, which CLI11 leaves out. `app` is as its parse left it.
std::string what_is_wrong(const CLI::App& app, const CLI::ParseError& error, int argc, char** argv);

}  // namespace awmr::cli
