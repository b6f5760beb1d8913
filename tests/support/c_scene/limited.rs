//! Tests with limited memory. The limit applies to a whole process, so each such test runs in a process of its own.

use std::process::Command;

use welkin::capi::device::*;

use super::{init, ok};

pub const MIB: u64 = 1 << 20;

#[repr(C)]
struct Limit {
    now: u64,
    most: u64,
}

unsafe extern "C" {
    fn setrlimit(resource: i32, limit: *const Limit) -> i32;
}

/// Limits the address space to what this process has now plus `bytes`; `None` lifts the limit.
pub fn leave(bytes: Option<u64>) {
    const RLIMIT_AS: i32 = 9;
    let pages = std::fs::read_to_string("/proc/self/statm").unwrap();
    let has: u64 = pages.split(' ').next().unwrap().parse().unwrap();
    let now = bytes.map_or(u64::MAX, |b| has * 4096 + b);
    // SAFETY: a live pointer.
    assert_eq!(unsafe { setrlimit(RLIMIT_AS, &Limit { now, most: u64::MAX }) }, 0);
}

const CHILD: &str = "WELKIN_TEST_OF_MEMORY";

/// Runs the test `name` again in a process of its own, where memory may be limited. Returns true in that process.
pub fn in_a_process(name: &str) -> bool {
    if std::env::var_os(CHILD).is_some() {
        return true;
    }
    let mut child = Command::new(std::env::current_exe().unwrap());
    let out = child.args(["--exact", name, "--nocapture"]).env(CHILD, "1").output().unwrap();
    let text = [out.stdout, out.stderr].map(|t| String::from_utf8_lossy(&t).into_owned()).concat();
    assert!(out.status.success(), "{}\n{text}", out.status);
    false
}

/// Whether the device uses the process's memory, to which the limit applies. A graphics card has its own memory, which
/// no test should fill.
pub fn is_limited(device: *mut wk_device) -> bool {
    let mut caps = init::<wk_caps>("wk_caps");
    // SAFETY: live pointers.
    ok(unsafe { wk_device_get_caps(device, &mut caps) });
    caps.software == 1
}
