//! The `caustica` program: arguments in, pictures out. All the work is in the `caustica` library.

mod args;
mod checkpoint;
mod compare;
mod console;
mod develop;
mod failure;
mod info;
mod interrupt;
mod loading;
mod merge;
mod outputs;
mod progress;
mod prompt;
mod pyramid;
mod render;
mod replay;
mod snippet;
mod tests;
mod video;

use std::process::ExitCode;

use clap::Parser;

use args::{Arguments, Command, Voice};
use console::Console;
use failure::Failure;

fn main() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(e) if e.use_stderr() && std::env::args_os().any(|a| a == "--json") => {
            return Console::new(true, false).fail(Failure::Usage(first_paragraph(&e)));
        }
        Err(e) => e.exit(),
    };
    let Voice { json, quiet } = arguments.voice();
    let mut console = Console::new(json, quiet);
    let result = match arguments.command {
        Command::Render(a) => render::run(&a, &mut console),
        Command::Compare(a) => compare::run(&a, &mut console),
        Command::Pyramid(a) => pyramid::run(&a, &mut console),
        Command::Video(a) => video::run(&a, &mut console),
        Command::Merge(a) => merge::run(&a, &console),
        Command::Develop(a) => develop::run(&a, &console),
        Command::Info(a) => info::run(&a, &mut console),
        Command::Test(a) => tests::run(&a, &mut console),
    };
    result.unwrap_or_else(|failure| console.fail(failure))
}

/// What is wrong with the arguments, without the advice that follows it.
fn first_paragraph(e: &clap::Error) -> String {
    let text = e.render().to_string();
    let paragraph = text.split("\n\n").next().unwrap_or_default();
    paragraph.trim_start_matches("error: ").split_whitespace().collect::<Vec<_>>().join(" ")
}
