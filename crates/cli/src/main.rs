//! The `caustica` program: arguments in, pictures out. All the work is in the `caustica` library.

mod args;
mod checkpoint;
mod compare;
mod console;
mod develop;
mod explain;
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
mod verify;
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
    #[cfg(feature = "planted-fault")]
    caustica::transport::fault::plant_from_environment();
    let Voice { json, quiet } = arguments.voice();
    let mut console = Console::new(json, quiet);
    if let Some(threads) = arguments.threads() {
        limit_threads(threads);
    }
    let result = match arguments.command {
        Command::Render(a) => render::run(&a, &mut console),
        Command::Compare(a) => compare::run(&a, &mut console),
        Command::Pyramid(a) => pyramid::run(&a, &mut console),
        Command::Video(a) => video::run(&a, &mut console),
        Command::Merge(a) => merge::run(&a, &console),
        Command::Develop(a) => develop::run(&a, &console),
        Command::Verify(a) => verify::run(&a, &mut console),
        Command::Explain(a) => explain::run(&a, &mut console),
        Command::Info(a) => info::run(&a, &mut console),
        Command::Test(a) => tests::run(&a, &mut console),
    };
    result.unwrap_or_else(|failure| console.fail(failure))
}

/// Also what renders nothing, such as the building of trees and the packing of films, keeps to that many threads; and
/// takes no more of them than the machine has.
fn limit_threads(threads: usize) {
    let threads = threads.min(caustica::session::available_threads());
    // It fails only if such work has begun already, which it has not.
    let _ = rayon::ThreadPoolBuilder::new().num_threads(threads).build_global();
}

/// What is wrong with the arguments, without the advice that follows it.
fn first_paragraph(e: &clap::Error) -> String {
    let text = e.render().to_string();
    let paragraph = text.split("\n\n").next().unwrap_or_default();
    paragraph.trim_start_matches("error: ").split_whitespace().collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod thread_tests {
    /// No other test of the program alone uses these threads.
    #[test]
    fn all_work_keeps_to_the_threads_that_are_asked_for() {
        super::limit_threads(1);
        assert_eq!(rayon::current_num_threads(), 1);
    }
}
