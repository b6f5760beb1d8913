//! The lab: speed charted against accuracy, growth of cost, and maps of where methods fail.
//!
//! `make lab ARGS="chart sky"`. Results are kept row by row: a run that was stopped is continued by the same command.
//! Wrong arguments: a message on standard error, exit code 2, nothing written; pictures that differ: exit code 1.

#[path = "../../tests/rain/brute.rs"]
#[allow(dead_code)] // The tests need more of it.
mod brute;
mod candidates;
mod canvas;
mod chart;
mod clouds;
mod cloudscapes;
#[path = "../../tests/support/coarse_sky.rs"]
mod coarse_sky;
mod command;
mod compare;
mod effect_charts;
mod fog;
mod front;
#[path = "../../tests/support/fullscreen.rs"]
mod fullscreen;
mod genera;
mod growth;
mod page;
mod painted;
mod painted_chart;
mod peers;
mod picture;
mod plot;
mod quadrature;
mod rain;
mod regression;
mod report;
mod scenes;
#[path = "../shared/mod.rs"]
#[allow(dead_code)] // Its charts say themselves how far they are.
mod shared;
mod sky;
mod snow;
mod source_lod;
mod stability;
mod stars;
mod store;
mod timing;
mod wind_flakes;

use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if let Some(text) = shared::answered("lab", command::USAGE, arguments.iter().cloned()) {
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
