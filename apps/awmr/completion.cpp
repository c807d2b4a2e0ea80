#include "command_info.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace awmr::cli {
namespace {

/// Single-quotes a string for bash, zsh and fish. Each quote within the string is replaced: the
/// quoted part ends, an escaped quote follows, and a new quoted part begins.
std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) {
    if (c == '\'') {
      result += "'\\''";
    } else {
      result += c;
    }
  }
  return result + "'";
}

/// Shortens an option's description: returns the text before the first colon, semicolon or bracket.
std::string brief(const std::string& meaning) {
  const std::size_t end = meaning.find_first_of(":;(");
  std::string text = meaning.substr(0, end);
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

std::vector<std::string> words_of(const CommandInfo& command) {
  std::vector<std::string> words;
  for (const OptionInfo& option : command.options) {
    if (option.positional) continue;
    words.push_back(option.name);
    if (!option.short_name.empty()) words.push_back(option.short_name);
  }
  return words;
}

std::vector<std::string> names_of(const std::vector<CommandInfo>& commands) {
  std::vector<std::string> names;
  for (const CommandInfo& command : commands) {
    if (!command.name.empty()) names.push_back(command.name);
  }
  return names;
}

// ---- bash: the word before the current one determines which words can complete it

std::string bash_action(const OptionInfo& option) {
  switch (option.kind) {
    case ValueKind::kChoice:
      return fmt::format("_awmr_words '{}'", fmt::join(option.choices, " "));
    case ValueKind::kFile:
      return "_awmr_paths -f";
    case ValueKind::kDirectory:
      return "_awmr_paths -d";
    default:
      return "COMPREPLY=()";
  }
}

std::string bash_command(const CommandInfo& command) {
  std::string cases;
  std::string rest = "COMPREPLY=()";
  for (const OptionInfo& option : command.options) {
    if (option.positional) {
      rest = bash_action(option);
    } else if (option.kind != ValueKind::kNone) {
      const std::string pattern =
          option.short_name.empty() ? option.name : option.name + "|" + option.short_name;
      cases += fmt::format("        {}) {}; return ;;\n", pattern, bash_action(option));
    }
  }
  return fmt::format(
      "    {})\n      case $previous in\n{}      esac\n"
      "      if [[ $current == -* ]]; then _awmr_words '{}'; else {}; fi ;;\n",
      command.name, cases, fmt::join(words_of(command), " "), rest);
}

std::string bash_text(const std::vector<CommandInfo>& commands) {
  std::string text =
      "# bash completion of awmr, made by `awmr completion bash`.\n"
      "_awmr_words() { mapfile -t COMPREPLY < <(compgen -W \"$1\" -- \"$current\"); }\n"
      "_awmr_paths() {\n"
      "  compopt -o filenames 2>/dev/null\n"
      "  mapfile -t COMPREPLY < <(compgen \"$1\" -- \"$current\")\n"
      "}\n"
      "_awmr() {\n"
      "  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD-1]}\n"
      "  # --option=value comes as three words.\n"
      "  if [[ $current == = ]]; then current=\n"
      "  elif [[ $previous == = ]]; then previous=${COMP_WORDS[COMP_CWORD-2]}; fi\n"
      "  if ((COMP_CWORD == 1)); then\n";
  std::vector<std::string> first = names_of(commands);
  for (const std::string& word : words_of(commands.front())) first.push_back(word);
  text += fmt::format("    _awmr_words '{}'\n    return\n  fi\n  case ${{COMP_WORDS[1]}} in\n",
                      fmt::join(first, " "));
  for (const CommandInfo& command : commands) {
    if (!command.name.empty()) text += bash_command(command);
  }
  return text + "  esac\n}\ncomplete -F _awmr awmr\n";
}

// ---- zsh: one specification for each option, which the zsh function _arguments reads

/// Escapes colons and brackets, which separate the parts of a zsh specification.
std::string zsh_part(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == ':' || c == '[' || c == ']' || c == '\\') result += '\\';
    result += c;
  }
  return result;
}

std::string zsh_action(const OptionInfo& option) {
  const std::string value = zsh_part(option.value.empty() ? option.name : option.value);
  switch (option.kind) {
    case ValueKind::kChoice:
      return fmt::format(":{}:({})", value, fmt::join(option.choices, " "));
    case ValueKind::kFile:
      return fmt::format(":{}:_files", value);
    case ValueKind::kDirectory:
      return fmt::format(":{}:_files -/", value);
    case ValueKind::kOther:
      return fmt::format(":{}: ", value);
    default:
      return "";
  }
}

std::string zsh_options(const CommandInfo& command) {
  std::string text;
  for (const OptionInfo& option : command.options) {
    const std::string action = zsh_action(option);
    if (option.positional) {
      text += fmt::format(" \\\n            {}", quoted((option.repeats ? "*" : "1") + action));
      continue;
    }
    const std::string help = fmt::format("[{}]", zsh_part(brief(option.meaning)));
    const bool has_value = option.kind != ValueKind::kNone;
    const std::string name = option.name + (has_value ? "=" : "");
    if (option.short_name.empty()) {
      text += fmt::format(" \\\n            {}",
                          quoted((option.repeats ? "*" : "") + name + help + action));
      continue;
    }
    const std::string both = fmt::format("({} {})", option.short_name, option.name);
    for (const std::string& one : {option.short_name + (has_value ? "+" : ""), name}) {
      text += fmt::format(" \\\n            {}", quoted(both + one + help + action));
    }
  }
  return text;
}

std::string zsh_text(const std::vector<CommandInfo>& commands) {
  std::string list;
  std::string cases;
  for (const CommandInfo& command : commands) {
    if (command.name.empty()) continue;
    list += fmt::format("    {}\n", quoted(command.name + ":" + zsh_part(command.meaning)));
    cases += fmt::format("        {})\n          _arguments -s{} ;;\n", command.name,
                         zsh_options(command));
  }
  return fmt::format(
      "#compdef awmr\n"
      "# zsh completion of awmr, made by `awmr completion zsh`.\n"
      "_awmr() {{\n"
      "  local context state state_descr line\n"
      "  typeset -A opt_args\n"
      "  local -a commands\n"
      "  commands=(\n{}  )\n"
      "  _arguments -C{} \\\n"
      "            '1:command:->command' '*::argument:->argument'\n"
      "  case $state in\n"
      "    command) _describe -t commands command commands ;;\n"
      "    argument)\n"
      "      case $words[1] in\n{}      esac ;;\n"
      "  esac\n"
      "}}\n"
      "if [[ $funcstack[1] == _awmr ]]; then _awmr \"$@\"; else compdef _awmr awmr; fi\n",
      list, zsh_options(commands.front()), cases);
}

// ---- fish: a line per option

std::string fish_values(const OptionInfo& option) {
  switch (option.kind) {
    case ValueKind::kChoice:
      return fmt::format(" -x -a '{}'", fmt::join(option.choices, " "));
    case ValueKind::kFile:
      return " -r -F";
    case ValueKind::kDirectory:
      return " -x -a '(__fish_complete_directories)'";
    case ValueKind::kOther:
      return " -x";
    default:
      return "";
  }
}

std::string fish_line(const std::string& condition, const OptionInfo& option) {
  std::string line = fmt::format("complete -c awmr -n '{}'", condition);
  if (!option.positional) {
    line += " -l " + option.name.substr(2);
    if (!option.short_name.empty()) line += " -s " + option.short_name.substr(1);
  }
  std::string values = fish_values(option);
  // The flag `-r` of fish (the option requires a value) has no effect on positional arguments.
  if (option.positional && values.starts_with(" -r")) values = " -F";
  return line + values + " -d " + quoted(brief(option.meaning)) + "\n";
}

std::string fish_text(const std::vector<CommandInfo>& commands) {
  std::string text =
      "# fish completion of awmr, made by `awmr completion fish`.\n"
      "complete -c awmr -f\n";
  for (const CommandInfo& command : commands) {
    const std::string condition = command.name.empty()
                                      ? "__fish_use_subcommand"
                                      : "__fish_seen_subcommand_from " + command.name;
    if (!command.name.empty()) {
      text += fmt::format("complete -c awmr -n '__fish_use_subcommand' -a {} -d {}\n", command.name,
                          quoted(brief(command.meaning)));
    }
    for (const OptionInfo& option : command.options) text += fish_line(condition, option);
  }
  return text;
}

}  // namespace

std::string completion_text(Shell shell, const std::vector<CommandInfo>& commands) {
  switch (shell) {
    case Shell::kBash:
      return bash_text(commands);
    case Shell::kZsh:
      return zsh_text(commands);
    case Shell::kFish:
      return fish_text(commands);
  }
  return {};
}

}  // namespace awmr::cli
