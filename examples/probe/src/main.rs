//! Queries the drawn models from a script. Reads CSV with a header on standard input, and prints each line with the
//! answer's columns appended.
//!
//! ```text
//! probe sky|aerial|irradiance --planet FILE [--model table3d|isotropic|directional|brute-force]
//! probe fog --visibility METRES
//! probe rain-speed
//! probe snow-speed
//! probe rain
//! probe ice
//! probe slab
//! probe cover --genus NAME --okta 0..8 --seeds N
//! probe cloud-shape --genus NAME --okta 0..8 --seeds N [--pixel METRES]
//! probe soil-force
//! probe soil-wall
//! probe soil-sinkage
//! probe soil-heap
//! probe lightning --rate FLASHES_A_MINUTE --hours H
//! probe cavity --re R --n N
//! probe taylor-green --n N --cfl C [--scheme semi-lagrangian|maccormack|reflection]
//! probe wind --scene FILE
//! probe sea --hs METRES --tp SECONDS --depth METRES [--seed S]
//! probe sea-at --hs METRES --tp SECONDS --depth METRES [--seed S]
//! ```
//! Wrong input: prints line and column on standard error and nothing on standard output, with exit code 2.

use std::io::Write as _;
use std::process::ExitCode;

use welkin::{Error, Status};
use welkin_probe::command;

fn main() -> ExitCode {
    if let Some(text) = welkin_command_line::answered("probe", command::USAGE, std::env::args().skip(1)) {
        print!("{text}");
        return ExitCode::SUCCESS;
    }
    let done =
        welkin_command_line::at_work("probe", "working", || command::run(std::env::args().skip(1))).and_then(|out| {
            let failed = |e: std::io::Error| Error::new(Status::Io, format!("writing the answers: {e}"));
            std::io::stdout().write_all(out.as_bytes()).map_err(failed)
        });
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(e) => {
            eprintln!("probe: {e}");
            ExitCode::from(2)
        }
    }
}
