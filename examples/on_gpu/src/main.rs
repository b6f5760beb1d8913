//! Steps of `scripts/on-gpu`. Each tests one behaviour of an OpenGL driver on the sky's first tables, in a process of
//! its own, because the GPU may hang. Prints `RESULT ok ..`, `RESULT wrong ..` or `RESULT none ..`, or nothing if the
//! driver does not finish.
//!
//! `on_gpu --help` lists the steps.

#[cfg(target_os = "linux")]
fn main() -> std::process::ExitCode {
    use std::process::ExitCode;

    use welkin_on_gpu::{STEPS, answer};
    let steps: Vec<_> = STEPS.iter().map(|(step, what, _)| format!("  {step:22} {what}")).collect();
    let usage = format!(
        "usage: on_gpu STEP | --help | --version\n\nWELKIN_EGL_DEVICE=N asks the OpenGL driver of EGL's device N. Steps:\n{}",
        steps.join("\n")
    );
    if let Some(text) = welkin_command_line::answered("on_gpu", &usage, std::env::args().skip(1)) {
        print!("{text}");
        return ExitCode::SUCCESS;
    }
    let mut arguments = std::env::args().skip(1);
    let name = match (arguments.next(), arguments.next()) {
        (Some(name), None) => name,
        (None, _) => {
            eprintln!("on_gpu: names no step: on_gpu --help lists them");
            return ExitCode::from(2);
        }
        (_, Some(more)) => {
            eprintln!("on_gpu: unexpected argument {more}: on_gpu --help says what it takes");
            return ExitCode::from(2);
        }
    };
    env_logger::init();
    let Some((line, code)) = answer(&name) else {
        eprintln!("on_gpu: {name} is no step: on_gpu --help lists them");
        return ExitCode::from(2);
    };
    println!("{line}");
    ExitCode::from(code)
}

#[cfg(not(target_os = "linux"))]
fn main() {
    eprintln!("on_gpu: asks EGL, which is asked on Linux only");
}
