#include "command_info.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sstream>

#include "awmr/core/provenance.h"

namespace awmr::cli {
namespace {

/// Escapes text for roff, so that it prints literally and hyphens can be copied.
std::string roff(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '\\') {
      result += "\\e";
    } else if (c == '-') {
      result += "\\-";
    } else if (c == '\'') {
      result += "\\(aq";
    } else if (c == '`') {
      result += "\\(ga";
    } else if (c == '^') {
      result += "\\(ha";
    } else if (c == '~') {
      result += "\\(ti";
    } else {
      result += c;
    }
  }
  return result;
}

/// Escapes a line that begins with a dot, because roff would read it as a request.
std::string roff_line(const std::string& text) {
  return (text.starts_with(".") ? "\\&" : "") + roff(text) + "\n";
}

std::string bold(const std::string& text) { return "\\fB" + roff(text) + "\\fR"; }
std::string italic(const std::string& text) { return "\\fI" + roff(text) + "\\fR"; }

/// Returns the first line of a text, without a full stop at its end.
std::string first_line(const std::string& text) {
  std::string line = text.substr(0, text.find('\n'));
  while (line.ends_with('.')) line.pop_back();
  return line;
}

std::string head(const CommandInfo& command, const std::string& purpose) {
  std::string title = page_name(command);
  for (char& c : title) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  // The header has no date, so that the same program always writes the same bytes.
  return fmt::format(".TH {} 1 \"\" \"awmr {}\" \"awmr manual\"\n.SH NAME\n{} \\- {}\n",
                     roff(title), version(), roff(page_name(command)), roff(purpose));
}

std::string synopsis(const CommandInfo& command) {
  std::string text = ".SH SYNOPSIS\n.B awmr " + roff(command.name) + "\n";
  for (const OptionInfo& option : command.options) {
    if (option.positional) {
      text += italic(option.name) + (option.repeats ? " ...\n" : "\n");
    } else if (option.required) {
      text += bold(option.name) + " " + italic(option.value) + "\n";
    }
  }
  return text + "[" + italic("OPTIONS") + "]\n";
}

std::string tag(const OptionInfo& option) {
  if (option.positional) return italic(option.name);
  std::string text = option.short_name.empty() ? "" : bold(option.short_name) + ", ";
  text += bold(option.name);
  if (option.kind != ValueKind::kNone) text += " " + italic(option.value);
  return text;
}

std::string entry(const OptionInfo& option) {
  std::string text = ".TP\n" + tag(option) + "\n" + roff_line(option.meaning);
  std::vector<std::string> more;
  if (!option.choices.empty()) {
    more.push_back(fmt::format("One of: {}.", fmt::join(option.choices, ", ")));
  }
  if (!option.range.empty()) more.push_back(fmt::format("A value {}.", option.range));
  if (option.required) more.emplace_back("Required.");
  if (!more.empty()) text += ".br\n" + roff_line(fmt::format("{}", fmt::join(more, " ")));
  return text;
}

/// Formats the help text below the options; examples are printed verbatim.
std::string footer(const std::string& text) {
  std::string examples;
  std::string rest;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("Example")) continue;
    if (line.starts_with("  ")) {
      examples += roff_line(line.substr(2));
    } else if (!line.starts_with("Exit codes")) {
      rest += roff_line(line);
    }
  }
  std::string page;
  if (!examples.empty()) page += ".SH EXAMPLES\n.nf\n.RS 4\n" + examples + ".RE\n.fi\n";
  if (!rest.empty()) page += ".SH NOTES\n" + rest;
  return page;
}

constexpr const char* kExitStatus =
    ".SH EXIT STATUS\n"
    ".TP\n.B 0\nDone.\n"
    ".TP\n.B 1\nThe command ran with a negative result: the data do not identify a requested\n"
    "parameter, no gains meet the constraints, or a validation failed.\n"
    ".TP\n.B 2\nThe command line, a file or a value is wrong.\n"
    ".TP\n.B 3\nA fault of the program itself.\n";

std::string see_also(const CommandInfo& command, const std::vector<CommandInfo>& commands) {
  std::vector<std::string> pages;
  for (const CommandInfo& other : commands) {
    const bool wanted = command.name.empty() != other.name.empty();
    if (wanted) pages.push_back("\\fB" + roff(page_name(other)) + "\\fR(1)");
  }
  return fmt::format(".SH SEE ALSO\n{}\n", fmt::join(pages, ",\n"));
}

std::string options_of(const CommandInfo& command) {
  std::string text = ".SH OPTIONS\n";
  for (const OptionInfo& option : command.options) text += entry(option);
  return text;
}

/// Page of the program: purpose and commands.
std::string program_page(const CommandInfo& program, const std::vector<CommandInfo>& commands) {
  std::string text =
      head(program, "parameter identification and tuning for autonomous wheeled robots");
  text += ".SH SYNOPSIS\n.B awmr\n" + italic("COMMAND") + "\n[" + italic("OPTIONS") + "]\n";
  text += ".SH DESCRIPTION\n.nf\n";
  std::istringstream lines(program.meaning);
  for (std::string line; std::getline(lines, line);) text += roff_line(line);
  text += ".fi\n.SH COMMANDS\n";
  for (const CommandInfo& command : commands) {
    if (command.name.empty()) continue;
    text += ".TP\n" + bold(command.name) + "\n" + roff_line(command.meaning);
  }
  return text + options_of(program) + footer(program.footer) + kExitStatus;
}

}  // namespace

std::string page_name(const CommandInfo& command) {
  return command.name.empty() ? "awmr" : "awmr-" + command.name;
}

std::string man_page(const CommandInfo& command, const std::vector<CommandInfo>& commands) {
  if (command.name.empty()) return program_page(command, commands) + see_also(command, commands);
  return head(command, first_line(command.meaning)) + synopsis(command) + ".SH DESCRIPTION\n" +
         roff_line(command.meaning + ".") + options_of(command) + footer(command.footer) +
         kExitStatus + see_also(command, commands);
}

}  // namespace awmr::cli
