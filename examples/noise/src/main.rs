//! Makes textures of noise: parameters in, a preview and files for a host or for Welkin out. The noise is the library's
//! own.
//!
//! ```text
//! noise FILE.. [--kind gradient|cellular|both] [--size WIDTHxHEIGHT[xDEPTH]] [--frequency CELLS[,CELLS[,CELLS]]]
//!       [--octaves N] [--amplitude A] [--persistence P] [--seed N] [--preset overcast|broken|few] [--from FILE] [--gpu]
//!       [--cutoff C | --cover SHARE] [--density D] [--slice Z] [--tiles N]
//! ```
//! Each FILE ends in .dds, .ktx2 (with mip levels) or .png (a look at one slice, N x N tiles of it). With a cutoff or a
//! cover and a density the texels are opacities of clouds, and previews show them white on blue. Wrong input: exit code
//! 2, nothing written.

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
