//! Manual pages: one for each command, with all that its help says.

#[path = "../../examples/man/pages.rs"]
mod pages;

use std::collections::BTreeMap;

/// The pages as they are read, without what sets them.
fn read() -> BTreeMap<String, String> {
    let pages = pages::pages(bounce_audio::cli::command()).unwrap();
    let plain = |page: Vec<u8>| {
        let text = String::from_utf8(page).unwrap();
        ["\\fB", "\\fI", "\\fR", "\\&"]
            .iter()
            .fold(text, |text, set| text.replace(set, ""))
            .replace("\\-", "-")
            .replace("\\*(Aq", "'")
    };
    pages
        .into_iter()
        .map(|(name, page)| (name, plain(page)))
        .collect()
}

#[test]
fn every_command_has_a_page_with_its_options_and_examples_line_by_line() {
    let pages = read();
    let mut program = bounce_audio::cli::command();
    program.build();
    let commands = program.get_subcommands().filter(|c| c.get_name() != "help");
    let mut count = 1;
    for command in commands {
        count += 1;
        let page = &pages[&format!("bounce-audio-{}.1", command.get_name())];
        for option in command.get_arguments().filter_map(|of| of.get_long()) {
            assert!(page.contains(&format!("--{option}")), "{option}: {page}");
        }
        let help = command.get_after_help().unwrap().to_string();
        for line in help.lines().skip(1) {
            let line = line.replace('\\', "\\\\");
            assert!(page.contains(&format!("\n{line}\n")), "{line}: {page}");
        }
        assert!(
            pages["bounce-audio.1"].contains(&format!("bounce-audio-{}(1)", command.get_name()))
        );
    }
    assert_eq!(pages.len(), count);
}
