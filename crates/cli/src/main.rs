//! The `caustica` program: arguments in, pictures out. All the work is in the `caustica` library.

mod args;
mod develop;
mod failure;
mod info;
mod loading;
mod progress;
mod prompt;
mod render;
mod replay;
//mod tests;

use std::process::ExitCode;

use clap::Parser;

use args::{Arguments, Command};

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let json = arguments.json();
    let result = match arguments.command {
        Command::Render(a) => render::run(&a),
        Command::Develop(a) => develop::run(&a),
        Command::Info(a) => info::run(&a),
        Command::Test(_) => unimplemented!(),
    };
    match result {
        Ok(code) => code,
        Err(failure) => failure.tell(json),
    }
}
