//! Gathers `shaders/**/*.wgsl` into one table of the crate, so that the library carries its shaders and a new
//! file needs no registration. Writes the C header and the boundary's tables from `src/capi`.
#[path = "build/abi.rs"]
mod abi;
#[path = "build/header.rs"]
mod header;

use std::{fs, io::Write, path::Path, path::PathBuf};

fn gather(dir: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(dir).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() {
            gather(&path, found);
        } else if path.extension().is_some_and(|e| e == "wgsl") {
            found.push(path);
        }
    }
}

fn main() {
    println!("cargo:rerun-if-changed=shaders");
    let root = PathBuf::from(std::env::var("CARGO_MANIFEST_DIR").expect("cargo sets CARGO_MANIFEST_DIR"));
    let out = PathBuf::from(std::env::var("OUT_DIR").expect("cargo sets OUT_DIR")).join("shader_table.rs");
    let mut found = Vec::new();
    gather(&root.join("shaders"), &mut found);
    found.sort();
    let mut file = fs::File::create(out).expect("OUT_DIR is writable");
    writeln!(file, "pub(super) static SHADERS: &[(&str, &str)] = &[").expect("write");
    for path in found {
        println!("cargo:rerun-if-changed={}", path.display());
        let name = path.strip_prefix(root.join("shaders")).expect("below shaders/");
        let name = name.to_string_lossy().replace('\\', "/");
        writeln!(file, "    ({name:?}, include_str!({:?})),", path.display().to_string()).expect("write");
    }
    writeln!(file, "];").expect("write");
    write_capi(&root);
}

/// `OUT_DIR/welkin.h` (a test holds the committed one against it) and what `src/capi/boundary/layout.rs` includes.
fn write_capi(root: &Path) {
    println!("cargo:rerun-if-changed=build");
    let out = PathBuf::from(std::env::var("OUT_DIR").expect("cargo sets OUT_DIR"));
    let model = abi::read(&root.join("src/capi"));
    let write = |name: &str, text: String| fs::write(out.join(name), text).expect("OUT_DIR is writable");
    write("abi_table.rs", abi::write_table(&model));
    for section in &model.sections {
        write(&format!("init_{}.rs", section.module), abi::write_inits(section));
    }
    let version = std::env::var("CARGO_PKG_VERSION").expect("cargo sets the version");
    write("welkin.h", header::write(&model, &out, &root.join("cbindgen.toml"), &version));
}
