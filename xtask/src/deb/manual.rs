//! The manual pages of the command and of its subcommands, made from their `--help` by help2man.

use std::path::Path;
use std::process::Command;

use crate::shell::{Result, command, output};
use crate::source_date::SourceDate;

/// Returns the manual pages, each with its name: `opendr`, `opendr-infer`, ...
pub fn pages(opendr: &Path, date: SourceDate) -> Result<Vec<(String, String)>> {
    let help = output(command(opendr).arg("--help"))?;
    let commands = commands(&help);
    if commands.is_empty() {
        return Err(format!("{} --help lists no commands", opendr.display()));
    }
    let about = "perception and learning for robots";
    let mut pages = vec![("opendr".to_owned(), page(opendr, None, about, &commands, date)?)];
    for (name, about) in &commands {
        pages.push((format!("opendr-{name}"), page(opendr, Some(name), about, &commands, date)?));
    }
    Ok(pages)
}

/// Returns the subcommands in the output of `--help`, each with its description.
fn commands(help: &str) -> Vec<(String, String)> {
    let lines = help.lines().skip_while(|line| *line != "Commands:").skip(1);
    let lines = lines.take_while(|line| line.starts_with("  "));
    let found = lines.filter_map(|line| line.trim().split_once("  "));
    let found = found.map(|(name, about)| (name.to_owned(), about.trim().to_owned()));
    found.filter(|(name, _)| name != "help").collect()
}

fn page(
    opendr: &Path,
    subcommand: Option<&str>,
    about: &str,
    commands: &[(String, String)],
    date: SourceDate,
) -> Result<String> {
    let program = subcommand.map_or_else(
        || opendr.display().to_string(),
        |subcommand| format!("{} {subcommand}", opendr.display()),
    );
    let mut help2man = Command::new("help2man");
    help2man.args(["--no-info", "--section=1", "--manual=OpenDR", "--source=OpenDR"]);
    help2man.arg(format!("--version-string={}", env!("CARGO_PKG_VERSION")));
    help2man.arg(format!("--name={}", about.replace('\\', "")));
    help2man.env("SOURCE_DATE_EPOCH", date.seconds().to_string()).env("LC_ALL", "C.UTF-8");
    // The name of a manual page has no space.
    let name = own(subcommand);
    let page = output(help2man.arg(program))?;
    let page = page.replacen(".TH OPENDR ", &format!(".TH {} ", name.to_uppercase()), 1);
    let page = page.replacen(&format!("\n{} \\-", name.replace('-', " ")), &format!("\n{name} \\-"), 1);
    let others = commands.iter().map(|(name, _)| format!(".BR opendr-{name} (1)"));
    let others: Vec<_> = std::iter::once(".BR opendr (1)".to_owned())
        .chain(others)
        .filter(|line| *line != format!(".BR {name} (1)"))
        .collect();
    Ok(format!("{page}.SH \"SEE ALSO\"\n{}\n", others.join(",\n")))
}

fn own(subcommand: Option<&str>) -> String {
    subcommand.map_or_else(|| "opendr".to_owned(), |name| format!("opendr-{name}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_the_subcommands() {
        let help = "About\n\nCommands:\n  infer  Run a learner\n  ros2   Run nodes\n  help   Print this\n\nOptions:\n  -h  Print\n";
        let names: Vec<_> = commands(help).into_iter().map(|(name, _)| name).collect();
        assert_eq!(names, ["infer", "ros2"]);
    }
}
