//! Help texts, messages and the examples of `docs/machine.md`, `docs/pixel.md`, `docs/bits.md`, `docs/inject.md` and `docs/servers.md`, word by word: `tests/cmd/*.trycmd`. `TRYCMD=overwrite cargo test -p lancer help` renews them.

use super::session::Session;

#[test]
fn help_and_messages_say_what_they_said() {
    trycmd::TestCases::new()
        .case("tests/cmd/*.trycmd")
        .case("docs/machine.md")
        .case("docs/pixel.md")
        .case("docs/bits.md")
        .case("docs/inject.md")
        .case("docs/servers.md");
}

/// A command and all commands below it, from what their help lists.
pub fn commands(session: &Session, above: &str) -> Vec<String> {
    let help = session.succeed(&format!("{above} --help"));
    let listed = help.lines().skip_while(|line| *line != "Commands:").skip(1).take_while(|line| !line.is_empty());
    // A name stands two columns from the left; what is said on it may go on below, further to the right.
    let first = |line: &'_ str| line.strip_prefix("  ").is_some_and(|rest| !rest.starts_with(' '));
    let names = listed.filter(|line| first(line)).filter_map(|line| line.split_whitespace().next());
    let names = names.filter(|name| *name != "help");
    let below = names.flat_map(|name| commands(session, &format!("{above} {name}")));
    std::iter::once(above.to_owned()).chain(below).collect()
}

#[test]
fn every_command_has_examples_and_every_option_a_sentence() {
    let session = Session::new();
    let commands = commands(&session, "");
    assert!(commands.len() > 8 && commands.contains(&" scene info".to_owned()), "{commands:?}");
    for command in commands {
        let help = session.succeed(&format!("{command} --help"));
        assert!(help.contains("Examples:\n  lancer"), "{command} has no examples");
        let lines: Vec<&str> = help.lines().collect();
        for (number, line) in lines.iter().enumerate().filter(|(_, line)| line.trim_start().starts_with("--")) {
            let is_beside = line.trim_start().contains("  ");
            let is_below = lines.get(number + 1).is_some_and(|next| !next.trim().is_empty());
            assert!(is_beside || is_below, "{command}: nothing is said on {line}");
        }
        let name = format!("tests/cmd/help{}.trycmd", command.replace(' ', "-"));
        assert!(std::path::Path::new(&name).exists(), "{name} is missing");
    }
}

#[test]
fn every_shell_has_its_completions() {
    let session = Session::new();
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = session.succeed(&format!("completions {shell}"));
        assert!(script.contains("disassemble") && script.contains("weight-cutoff"), "{shell}");
    }
}

#[test]
fn the_man_page_has_every_command_and_every_option() {
    let session = Session::new();
    let page = session.succeed("manual --as man").replace("\\-", "-");
    for command in commands(&session, "") {
        let name = format!(".SH \"LANCER{}\"", command.to_uppercase());
        assert!(command.is_empty() || page.lines().any(|line| line == name), "{name}");
        let help = session.succeed(&format!("{command} --help"));
        let section = page.split(&name).nth(1).unwrap_or(&page);
        let words = help.split_whitespace().filter(|word| word.starts_with("--") && word.len() > 2);
        for option in words.map(|word| word.trim_end_matches([',', '.', ';', ')', '`'])) {
            let option = option.split(['[', '=']).next().unwrap();
            assert!(section.contains(option), "{command}: {option}");
        }
    }
}
