// `aspic completion`: prints completion scripts and the man page from the defined options.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "aspic/commands.h"
#include "aspic/other_programs.h"
#include "base/error.h"
#include "io/external_program.h"

namespace aspic::cli {
namespace {

struct OptionHelp {
  std::vector<std::string> names;  // "-o", "--output"; for a positional argument its name
  std::string text;
  bool takes_value, is_positional;
};

struct CommandHelp {
  std::string name, text, footer;
  std::vector<OptionHelp> options;
};

OptionHelp help_of(const CLI::Option& option) {
  OptionHelp help{.names = {},
                  .text = option.get_description(),
                  .takes_value = option.get_expected_max() > 0,
                  .is_positional = option.get_positional()};
  if (help.is_positional) help.names.push_back(option.get_name(true));
  for (const std::string& name : option.get_snames()) help.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) help.names.push_back("--" + name);
  return help;
}

nlohmann::json to_json(const std::vector<CommandHelp>& commands) {
  nlohmann::json list = nlohmann::json::array();
  for (const CommandHelp& command : commands) {
    nlohmann::json options = nlohmann::json::array();
    for (const OptionHelp& o : command.options)
      options.push_back(
          {{"names", o.names}, {"text", o.text}, {"value", o.takes_value}, {"positional", o.is_positional}});
    list.push_back({{"name", command.name}, {"text", command.text}, {"footer", command.footer}, {"options", options}});
  }
  return list;
}

// Reads the help of a command from the program that has it.
CommandHelp help_from(const std::string& program, const std::string& command) {
  const TemporaryFolder folder;
  const std::filesystem::path output = folder.path() / "commands.json";
  run_program({.name = program,
               .command = {program, "completion", "json"},
               .about = command,
               .messages = folder.path() / "messages",
               .output = output,
               .after_signal = "it crashed",
               .when_unusable = "build it again",
               .out_of_time = -1});
  std::ifstream stream(output);
  const nlohmann::json list = nlohmann::json::parse(stream);
  for (const nlohmann::json& of : list) {
    if (of["name"] != command) continue;
    CommandHelp help{command, of["text"], of["footer"], {}};
    for (const nlohmann::json& o : of["options"])
      help.options.push_back({o["names"], o["text"], o["value"], o["positional"]});
    return help;
  }
  throw InvalidInput(program + ": has no command " + command + "; build it again");
}

std::vector<CommandHelp> commands_of(const CLI::App& app) {
  std::vector<CommandHelp> list;
  for (const CLI::App* command : app.get_subcommands(nullptr)) {
    if (const std::string program = command->get_prefix_command() ? program_with(command->get_name()) : "";
        !program.empty()) {
      list.push_back(help_from(program, command->get_name()));
      continue;
    }
    CommandHelp& help =
        list.emplace_back(CommandHelp{command->get_name(), command->get_description(), command->get_footer(), {}});
    for (const CLI::Option* option : command->get_options()) help.options.push_back(help_of(*option));
  }
  return list;
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size())
    text.replace(at, what.size(), by);
  return text;
}

std::vector<std::string> flags_of(const CommandHelp& command) {
  std::vector<std::string> flags;
  for (const OptionHelp& option : command.options)
    if (!option.is_positional) flags.insert(flags.end(), option.names.begin(), option.names.end());
  return flags;
}

std::string bash_script(const std::vector<CommandHelp>& commands) {
  std::string names, cases;
  for (const CommandHelp& command : commands) {
    names += " " + command.name;
    cases += fmt::format("    {}) options='{}' ;;\n", command.name, fmt::join(flags_of(command), " "));
  }
  return fmt::format(R"(# Completion of aspic's commands and options for bash.
_aspic() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} options=''
  if (( COMP_CWORD == 1 )); then
    COMPREPLY=($(compgen -W '{} --help --version' -- "$word"))
    return
  fi
  case ${{COMP_WORDS[1]}} in
{}  esac
  COMPREPLY=()
  if [[ $word == -* ]]; then COMPREPLY=($(compgen -W "$options" -- "$word")); fi
}}
complete -o default -F _aspic aspic
)",
                     names.substr(1), cases);
}

std::string quoted(const std::string& text) { return "'" + replaced(text, "'", "'\\''") + "'"; }

std::string zsh_script(const std::vector<CommandHelp>& commands) {
  std::string script = "#compdef aspic\nlocal -a commands\ncommands=(\n";
  for (const CommandHelp& command : commands)
    script += "  " + quoted(command.name + ":" + replaced(command.text, ":", "\\:")) + "\n";
  script +=
      ")\nif (( CURRENT == 2 )); then _describe command commands; return; fi\n"
      "local command=$words[2]\n(( CURRENT-- )); shift words\ncase $command in\n";
  for (const CommandHelp& command : commands) {
    script += "  " + command.name + ")\n    _arguments";
    for (const OptionHelp& option : command.options) {
      if (option.is_positional) continue;
      std::string text = option.text;
      for (const char* special : {"\\", "[", "]", ":"}) text = replaced(text, special, std::string("\\") + special);
      for (const std::string& name : option.names)
        script += " \\\n      " + quoted("*" + name + "[" + text + "]" + (option.takes_value ? ":value:_files" : ""));
    }
    script += " \\\n      '*:file:_files' ;;\n";
  }
  return script + "esac\n";
}

std::string fish_script(const std::vector<CommandHelp>& commands) {
  const auto fish_quoted = [](const std::string& text) {
    return "'" + replaced(replaced(text, "\\", "\\\\"), "'", "\\'") + "'";
  };
  std::string script = "# Completion of aspic's commands and options for fish.\n";
  for (const CommandHelp& command : commands) {
    script += fmt::format("complete -c aspic -n __fish_use_subcommand -f -a {} -d {}\n", command.name,
                          fish_quoted(command.text));
    for (const OptionHelp& option : command.options) {
      if (option.is_positional) continue;
      script += fmt::format("complete -c aspic -n '__fish_seen_subcommand_from {}'", command.name);
      for (const std::string& name : option.names)
        script += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
      script += (option.takes_value ? " -r -d " : " -d ") + fish_quoted(option.text) + "\n";
    }
  }
  return script;
}

// Escapes text for roff: hyphens can be copied, and no line starts a request.
std::string roff(const std::string& text) {
  std::string escaped = replaced(replaced(text, "\\", "\\e"), "-", "\\-");
  escaped = replaced(replaced(escaped, "\n.", "\n\\&."), "\n'", "\n\\&'");
  return escaped.starts_with('.') || escaped.starts_with('\'') ? "\\&" + escaped : escaped;
}

std::string verbatim(const std::string& text) {
  const size_t begin = text.find_first_not_of('\n');
  return begin == std::string::npos ? "" : ".PP\n.nf\n" + roff(text.substr(begin)) + "\n.fi\n";
}

std::string man_page(const CLI::App& app, const std::vector<CommandHelp>& commands) {
  const std::string version = version_text().substr(0, version_text().find('\n'));
  std::string page = fmt::format(
      ".TH ASPIC 1 \"\" \"{}\" \"User Commands\"\n.SH NAME\naspic \\- {}\n.SH SYNOPSIS\n.B aspic\n.I "
      "COMMAND\n[options]\n"
      ".SH DESCRIPTION\nThe commands are described below, each with its options and examples.\n.SH COMMANDS\n",
      version, roff(app.get_description()));
  for (const CommandHelp& command : commands) {
    page += ".SS aspic " + roff(command.name) + "\n" + roff(command.text) + ".\n";
    for (const OptionHelp& option : command.options) {
      page += fmt::format(".TP\n\\fB{}\\fR", roff(fmt::format("{}", fmt::join(option.names, ", "))));
      page += std::string(option.takes_value && !option.is_positional ? " \\fIVALUE\\fR" : "") + "\n";
      page += roff(option.text) + "\n";
    }
    if (command.footer != app.get_footer()) page += verbatim(command.footer);  // a command without footer inherits it
  }
  return page + ".SH EXAMPLES AND EXIT CODES\n" + verbatim(app.get_footer());
}

int print_completion(const CLI::App& app, const std::string& kind) {
  const std::vector<CommandHelp> commands = commands_of(app);
  const std::string text = kind == "json"   ? to_json(commands).dump()
                           : kind == "man"  ? man_page(app, commands)
                           : kind == "bash" ? bash_script(commands)
                           : kind == "zsh"  ? zsh_script(commands)
                                            : fish_script(commands);
  fmt::print("{}", text);
  return exit_done;
}

}  // namespace

void add_completion(CLI::App& app, Action& action) {
  const auto kind = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("completion", "Prints the completion script of a shell, or the man page");
  command->footer(
      "\nExamples:\n  aspic completion bash > ~/.local/share/bash-completion/completions/aspic\n"
      "  aspic completion man | man -l -\n'cmake --install' installs all of them.");
  command->add_option("KIND", *kind, "Output: bash, zsh, fish, man, or json")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish", "man", "json"}));
  command->callback([kind, &app, &action] { action = [kind, &app] { return print_completion(app, *kind); }; });
}

}  // namespace aspic::cli
