//! The program itself: JSON on standard output, what is wrong on standard error, and a headless session.

use std::fs;
use std::net::UdpSocket;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::Duration;

use crate::common::{captures, folder, message, packets};
use welkin_cigi_host::wire::{Order, Version};

fn program() -> Command {
    Command::new(env!("CARGO_BIN_EXE_cigi_host"))
}

fn run(words: &[&str]) -> Output {
    program().args(words).stdin(Stdio::null()).output().expect("the program starts")
}

fn scratch(name: &str, bytes: &[u8]) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("cigi-{name}"));
    fs::write(&path, bytes).expect("the target directory is writable");
    path
}

#[test]
fn captures_are_printed_in_their_own_form() {
    let capture = captures().into_iter().find(|c| c.name == "11-overlapping-regions.v40-be").expect("the capture");
    let path = folder().join(format!("{}.bin", capture.name));
    let done = run(&["--decode", path.to_str().expect("a name")]);
    assert!(done.status.success() && done.stderr.is_empty(), "{done:?}");
    let printed = String::from_utf8(done.stdout).expect("text");
    assert!(
        printed.contains("\"entity_or_region_id\": 2, ") && printed.contains("\"entity_or_region_id_at_byte_6\": 512")
    );
    assert_eq!(
        printed.split("\"datagrams\"").nth(1).map(str::trim),
        capture.json.split("\"datagrams\"").nth(1).map(str::trim)
    );
    let strict = run(&["--decode", path.to_str().expect("a name"), "--strict-ids", "--all"]);
    let strict = String::from_utf8(strict.stdout).expect("text");
    assert!(
        strict.contains("\"entity_or_region_id\": 512, ") && strict.contains("\"entity_type_substitution\": false")
    );
}

#[test]
fn what_is_wrong_with_a_capture_is_said() {
    let bytes = captures().remove(0).bytes;
    let bad = [&bytes[..bytes.len() - 1], &bytes[..2], &[9, 0, 0, 0, 1]];
    for (i, bytes) in bad.into_iter().enumerate() {
        let path = scratch(&format!("cut-{i}"), bytes);
        let done = run(&["--decode", path.to_str().expect("a name")]);
        let errors = String::from_utf8_lossy(&done.stderr).into_owned();
        assert_eq!((done.status.code(), done.stdout.len()), (Some(2), 0), "{errors}");
        assert!(errors.contains("byte ") && errors.contains(&format!("cigi-cut-{i}")), "{errors}");
    }
    let mut unknown = bytes.clone();
    unknown[6] = 77;
    let path = scratch("unknown", &unknown);
    let done = run(&["--decode", path.to_str().expect("a name")]);
    assert_eq!(done.status.code(), Some(1));
    let printed: serde_json::Value = serde_json::from_slice(&done.stdout).expect("JSON all the same");
    let refused = printed["datagrams"][0]["packets"][0]["refused"].as_str().expect("a reason").to_owned();
    assert!(refused.contains("must be IG Control or Start of Frame"), "{refused}");
}

#[test]
fn wrong_words_are_refused_by_name() {
    let cases: [(&[&str], &str); 15] = [
        (&[], "--decode or --listen is missing"),
        (&["--decode"], "--decode has no value"),
        (&["--decode", "/nowhere.bin"], "/nowhere.bin"),
        (&["--decode", "a", "--listen", "127.0.0.1:1"], "exclude each other"),
        (&["--decode", "a", "--rate", "60"], "--rate needs --listen"),
        (&["--listen", "here"], "--listen must be an address with a port"),
        (&["--listen", "127.0.0.1:0", "--all"], "--all needs --decode"),
        (&["--listen", "127.0.0.1:0", "--rate", "0.09"], "--rate must be in [0.1, 1000]"),
        (&["--listen", "127.0.0.1:0", "--rate", "nan"], "--rate must be in [0.1, 1000]"),
        (&["--listen", "127.0.0.1:0", "--rate", "9", "--lock-step"], "exclude each other"),
        (&["--listen", "127.0.0.1:0", "--cigi", "2"], "--cigi must be 3.3 or 4.0"),
        (&["--listen", "127.0.0.1:0", "--frames", "0"], "--frames must be a number from 1 on"),
        (&["--listen", "127.0.0.1:0", "--host", "x"], "--host must be an address"),
        (&["--listen", "127.0.0.1:0", "--site", "/nowhere.toml"], "/nowhere.toml"),
        (&["--lock"], "unknown option --lock"),
    ];
    for (words, named) in cases {
        let done = run(words);
        let errors = String::from_utf8_lossy(&done.stderr).into_owned();
        assert_eq!((done.status.code(), done.stdout.len()), (Some(2), 0), "{words:?}: {errors}");
        assert!(errors.starts_with("cigi_host: ") && errors.contains(named), "{words:?}: {errors}");
    }
    let site = scratch("site.toml", b"station_altitude_m = 1e9");
    let done = run(&["--listen", "127.0.0.1:0", "--site", site.to_str().expect("a name")]);
    let errors = String::from_utf8_lossy(&done.stderr).into_owned();
    assert!(done.status.code() == Some(2) && errors.contains("station_altitude_m must be in [-500, 9000]"), "{errors}");
}

#[test]
fn the_program_answers_a_host() {
    let free = UdpSocket::bind("127.0.0.1:0").expect("a port").local_addr().expect("an address").to_string();
    let ig = program()
        .args(["--listen", &free, "--lock-step", "--frames", "3"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn();
    let ig = ig.expect("the program starts");
    let host = UdpSocket::bind("127.0.0.1:0").expect("a port");
    host.set_read_timeout(Some(Duration::from_millis(500))).expect("a time");
    let mut extra = message(Version::V4_0, Order::Big, 77, &[]);
    extra.extend([0, 16, 0x12, 0x34, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]);
    let mut buffer = [0; 256];
    let mut answers = 0;
    // What is sent before the program listens is lost.
    for _ in 0..120 {
        host.send_to(&extra, &free).expect("sent");
        if let Ok(length) = host.recv(&mut buffer) {
            assert_eq!(packets(&buffer[..length]).len(), 1);
            answers += 1;
        }
        if answers == 1 {
            break;
        }
    }
    assert_eq!(answers, 1, "no answer in a minute");
    let done = ig.wait_with_output().expect("it ends after its frames");
    let (text, errors) = (String::from_utf8_lossy(&done.stdout), String::from_utf8_lossy(&done.stderr));
    assert!(done.status.success() && text.contains("x User-defined packet: ignored"), "{text} {errors}");
    for said in ["listening at 127.0.0.1:", "the host speaks CIGI 4.0, big-endian", "cigi_host: operate"] {
        assert!(errors.contains(said), "{errors}");
    }
}
