//! Creates noise textures: takes parameters and writes a preview, and files for a host or for Welkin. The noise is the
//! library's own.
//!
//! ```text
//! noise FILE.. [--kind gradient|cellular|both] [--size WIDTHxHEIGHT[xDEPTH]] [--frequency CELLS[,CELLS[,CELLS]]]
//!       [--octaves N] [--amplitude A] [--persistence P] [--seed N] [--preset overcast|broken|few] [--from FILE] [--gpu]
//!       [--cutoff C | --cover SHARE] [--density D] [--slice Z] [--tiles N]
//! ```
//! Each FILE ends in .dds, .ktx2 (with mip levels) or .png (a preview of one slice, repeated N x N times). With a
//! density and either a cutoff or a cover, the texels are opacities of clouds, and previews show them white on blue.
//! Wrong input gives exit code 2, and nothing is written.

use std::process::ExitCode;

use welkin_noise::{USAGE, run};

fn main() -> ExitCode {
    if let Some(text) = welkin_command_line::answered("noise", USAGE, std::env::args().skip(1)) {
        print!("{text}");
        return ExitCode::SUCCESS;
    }
    match welkin_command_line::at_work("noise", "making noise", || run(std::env::args().skip(1))) {
        Ok(said) => {
            println!("{said}");
            ExitCode::SUCCESS
        }
        Err(e) => {
            eprintln!("noise: {e}");
            ExitCode::from(2)
        }
    }
}
