//! The committed inputs that the fuzzers found worth keeping. Each has the result that it had before; `make fuzz` finds
//! more inputs.

use std::{fs, path::Path};

use welkin_support::fuzz::targets;

type Target = (&'static str, fn(&[u8]));

const TARGETS: [Target; 8] = [
    ("metar", targets::metar),
    ("planet", targets::planet),
    ("state", targets::state),
    ("plan", targets::plan),
    ("cache", targets::cache),
    ("noise", targets::noise),
    ("heights", targets::heights),
    ("calls", targets::calls),
];

#[test]
fn inputs_that_fuzzers_found_are_answered() {
    for (name, target) in TARGETS {
        let directory = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/corpus").join(name);
        let entries = fs::read_dir(&directory).unwrap_or_else(|e| panic!("{}: {e}", directory.display()));
        let mut inputs: Vec<_> = entries.map(|e| e.expect("readable").path()).collect();
        inputs.sort();
        for input in &inputs {
            let data = fs::read(input).expect("readable");
            let answered = std::panic::catch_unwind(|| target(&data));
            assert!(answered.is_ok(), "{}", input.display());
        }
        println!("{name}: {} inputs", inputs.len());
        assert!(inputs.len() >= 5, "{name}: {} inputs", inputs.len());
    }
}

/// The fuzz targets accept the repository's own files.
#[test]
fn own_files_are_read() {
    targets::states().iter().for_each(|state| targets::state(state));
    targets::plan(&targets::saved_plan());
    assert!(welkin::sky::takes_tables(&targets::tables()));
    assert!(!welkin::sky::takes_tables(&targets::tables()[1..]));
}
