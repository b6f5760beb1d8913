//! Conventions for the tools' command lines and for the files that they write.

use std::fs;
use std::path::Path;
use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::{Duration, Instant};

use welkin::{Error, Result, Status};

/// Text for standard output if the arguments contain `--help`, `-h` or `--version`; the program then ends with status
/// 0.
pub fn answered(name: &str, usage: &str, mut arguments: impl Iterator<Item = String>) -> Option<String> {
    arguments.find_map(|word| match word.as_str() {
        "--help" | "-h" => Some(format!("{usage}\n")),
        "--version" => Some(format!("{name} (Welkin {})\n", env!("CARGO_PKG_VERSION"))),
        _ => None,
    })
}

/// Runs work that may take long, and prints a progress message on standard error every few seconds.
pub fn at_work<T>(name: &str, what: &str, work: impl FnOnce() -> T) -> T {
    let began = Instant::now();
    let (ended, wait) = mpsc::channel::<()>();
    std::thread::scope(|threads| {
        threads.spawn(move || {
            while wait.recv_timeout(Duration::from_secs(3)) == Err(RecvTimeoutError::Timeout) {
                eprintln!("{name}: {what}, {:.0} s ..", began.elapsed().as_secs_f64());
            }
        });
        let done = work();
        drop(ended);
        done
    })
}

/// Writes a file under a temporary name beside it, then renames it. If the program is ended meanwhile, the previous
/// file remains.
///
/// # Errors
/// [`Status::Io`] with the file's name.
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<()> {
    let failed = |e: std::io::Error| Error::new(Status::Io, format!("{}: {e}", path.display()));
    let name = path.file_name().ok_or_else(|| failed(std::io::ErrorKind::InvalidFilename.into()))?;
    let part = path.with_file_name(format!(".{}.part", name.to_string_lossy()));
    let written = fs::write(&part, bytes).and_then(|()| fs::rename(&part, path));
    written.map_err(|e| {
        let _ = fs::remove_file(&part);
        failed(e)
    })
}

/// Writes an RGB picture as PNG, completely or not at all.
///
/// # Errors
/// [`Status::Io`] with the file's name.
pub fn write_png(path: &Path, rgb: &[u8], [width, height]: [u32; 2]) -> Result<()> {
    use image::ImageEncoder as _;
    let mut png = Vec::new();
    let encoder = image::codecs::png::PngEncoder::new(&mut png);
    let failed = |e| Error::new(Status::Io, format!("{}: {e}", path.display()));
    encoder.write_image(rgb, width, height, image::ExtendedColorType::Rgb8).map_err(failed)?;
    write_whole(path, &png)
}
