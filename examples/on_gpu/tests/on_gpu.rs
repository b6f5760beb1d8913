//! `scripts/on-gpu` as on a machine with a GPU: without network, display and compiler, from a folder of programs. The
//! driver here is a software driver, which passes every step. The script's decisions for a driver that fails are tested
//! with programs that only print such results.
#![cfg(target_os = "linux")]

use std::{
    fs,
    os::unix::fs::PermissionsExt,
    path::{Path, PathBuf},
    process::Command,
};

/// Creates a folder of programs, each a shell script.
fn pack(name: &str, on_gpu: &str, gl_host: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("on_gpu").join(name);
    fs::create_dir_all(folder.join("bin")).expect("the target directory is writable");
    let fine = "echo 'test result: ok. 1 passed'";
    for (program, body) in
        [("on_gpu", on_gpu), ("gl_host", gl_host), ("vulkan_host", fine), ("sky_gpu", fine), ("speed", fine)]
    {
        let path = folder.join("bin").join(program);
        fs::write(&path, format!("#!/bin/sh\n{body}\n")).expect("a program");
        fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).expect("it can be run");
    }
    folder
}

/// Runs the script, without a network where the machine allows that, and returns its page.
fn run(folder: &Path) -> String {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scripts/on-gpu");
    let out = folder.join("out");
    let can_leave = Command::new("unshare").args(["-rn", "true"]).output().is_ok_and(|o| o.status.success());
    let mut command = Command::new(if can_leave { "unshare" } else { "bash" });
    if can_leave {
        command.args(["-rn", "bash"]);
    }
    command.arg(&script).env("PACK", folder).env("OUT", &out).env("DISPLAY", ":4711");
    let output = command.output().expect("the script runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    fs::read_to_string(out.join("on-gpu.txt")).expect("the page")
}

/// Runs a step of the script in a process of its own.
#[test]
fn one_step() {
    let Ok(step) = std::env::var("WELKIN_ON_GPU_STEP") else { return };
    let (line, _) = welkin_on_gpu::answer(&step).expect("a step");
    println!("\n{line}");
}

#[test]
fn a_software_driver_answers_every_step_right() {
    let itself = std::env::current_exe().expect("this test");
    // The whole sky is left to other tests, because it takes minutes on a busy machine.
    let on_gpu = format!(
        "[ \"$1\" != welkin-own ] || {{ echo RESULT ok not asked here; exit; }}\nWELKIN_ON_GPU_STEP=\"$1\" exec '{}' \
         --exact one_step --nocapture --test-threads 2",
        itself.display()
    );
    let page = run(&pack("right", &on_gpu, "echo 'test result: ok. 2 passed'"));
    let decision = page.split("\nSTEPS\n").next().unwrap();
    assert!(decision.contains("DECISION\nNO HANG") && decision.contains("The whole sky is drawn too"), "{page}");
    let steps = page.split("\nSTEPS\n").nth(1).unwrap().split("\n\n").next().unwrap();
    for name in [
        "vulkan",
        "opengl",
        "blocks-read",
        "blocks-drawn-plain",
        "raw-while",
        "norm-constants",
        "norm-whole",
        "norm-uncapped",
    ] {
        assert!(steps.lines().any(|line| line.starts_with(&format!("{name:<30} ok "))), "{name}: {page}");
    }
}

#[test]
fn the_decision_follows_from_the_results_of_the_steps() {
    const WRONG: &str = "RESULT wrong dims, word 4: 0x00000000, not 0x00000008";
    let loops = "raw-while|norm-constants|norm|norm-plain|norm-written|norm-own";
    for (name, hung, wrong, shared_hangs, wanted) in [
        ("blocks", "none", "blocks-read|blocks-drawn", false, "CAUSE 1, blocks: shaders find other bytes"),
        ("uploads", "norm|norm-own", "none", false, "CAUSE 1, blocks: loops end with constants"),
        ("compiler", loops, "none", false, "CAUSE 2, the compiler"),
        ("contexts", "none", "none", true, "CAUSE 3, two contexts"),
        ("garbage", "none", "norm|norm-own", false, "CAUSE 1, blocks: loops end with constants"),
        ("whole", "norm-whole", "none", false, "NONE OF THE THREE"),
        ("caps", "norm-uncapped", "none", false, "MENDED"),
        ("nothing", "opengl", "none", false, "UNDECIDED: OpenGL does not come up"),
    ] {
        let on_gpu = format!(
            "case \"$1\" in {hung}) echo RESULT hangs said so; exit 4;; {wrong}) echo '{WRONG}'; exit 1;; esac\n\
             echo RESULT ok said so"
        );
        let hangs = if shared_hangs { "case \"$*\" in *beside*) echo RESULT hangs said so; exit;; esac\n" } else { "" };
        let page = run(&pack(name, &on_gpu, &format!("{hangs}echo 'test result: ok. 1 passed'")));
        let decision = page.split("DECISION\n").nth(1).unwrap();
        assert!(decision.starts_with(wanted), "{name}: {page}");
    }
}
