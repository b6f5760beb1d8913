//! The image generator's side of CIGI 3.3 and 4.0, without drawing: prints captures as JSON, and answers hosts over
//! UDP.
//!
//! Wrong options, and files that cannot be read, end it with status 2 and a sentence on standard error. Status 1 means
//! that packets of a capture were refused; the JSON says which, and why.

use std::io::Write as _;
use std::process::ExitCode;

use welkin_cigi_host::command;

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let has = |names: &[&str]| words.iter().any(|word| names.contains(&word.as_str()));
    let done = if has(&["--help", "-h"]) {
        Ok(command::Output { text: format!("{}\n", command::USAGE), refused: 0 })
    } else if has(&["--version"]) {
        let text = format!("cigi_host (Welkin {})\n", env!("CARGO_PKG_VERSION"));
        Ok(command::Output { text, refused: 0 })
    } else {
        command::run(words.into_iter())
    };
    let written = done.and_then(|output| {
        let failed = |e: std::io::Error| format!("writing to standard output: {e}");
        std::io::stdout().write_all(output.text.as_bytes()).map_err(failed)?;
        Ok(output.refused)
    });
    match written {
        Ok(0) => ExitCode::SUCCESS,
        Ok(refused) => {
            eprintln!("cigi_host: {refused} packets or datagrams were refused: see \"refused\" in the JSON");
            ExitCode::from(1)
        }
        Err(e) => {
            eprintln!("cigi_host: {e}");
            ExitCode::from(2)
        }
    }
}
