//! The lab: charts of speed against accuracy, growth of cost, and maps of where methods fail.
//!
//! `make lab ARGS="chart sky"`. Results are kept row by row, so the same command continues a stopped run. Wrong
//! arguments print a message on standard error and give exit code 2; nothing is written. Pictures that differ give exit
//! code 1.

use std::process::ExitCode;

use welkin_lab::command;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if let Some(text) = welkin_command_line::answered("lab", command::USAGE, arguments.iter().cloned()) {
        print!("{text}");
        return ExitCode::SUCCESS;
    }
    match command::run(&arguments) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(e) => {
            eprintln!("lab: {e}");
            ExitCode::from(2)
        }
    }
}
