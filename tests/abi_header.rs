//! The committed header: it equals the one generated from the sources, it compiles in every C and C++ standard, and C
//! sees the same structs and defaults as Rust. `WELKIN_BLESS=1` writes the committed header and lists anew.

use std::{collections::BTreeMap, fmt::Write as _, fs, path::Path, path::PathBuf, process::Command};

use welkin::capi::abi;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// A directory of this test's own.
fn scratch(name: &str) -> PathBuf {
    let dir = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    fs::create_dir_all(&dir).expect("the target directory is writable");
    dir
}

/// Compares `now` with a committed file, or writes the file when blessing.
fn compare(file: &str, now: &str) {
    let path = root().join(file);
    if std::env::var_os("WELKIN_BLESS").is_some() {
        fs::write(&path, now).expect("the working tree is writable");
    }
    let committed = fs::read_to_string(&path).unwrap_or_default();
    let first = committed.lines().zip(now.lines()).position(|(a, b)| a != b);
    let line = first.unwrap_or_else(|| committed.lines().count().min(now.lines().count()));
    assert!(
        committed == now,
        "{file} is out of date from line {} (`make header` writes it): committed {:?}, should be {:?}",
        line + 1,
        committed.lines().nth(line),
        now.lines().nth(line)
    );
}

fn run(command: &mut Command) -> String {
    let shown = format!("{command:?}");
    let output = command.output().unwrap_or_else(|e| panic!("{shown}: {e}"));
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{shown}: {}\n{errors}", output.status);
    String::from_utf8(output.stdout).expect("UTF-8")
}

#[test]
fn committed_header_is_what_the_sources_give() {
    compare("include/welkin.h", abi::HEADER);
}

/// Each section of the header is found from the table of contents by its name, and they are listed in the header's
/// order.
#[test]
fn contents_name_every_section_in_order() {
    let (opening, sections) = abi::HEADER.split_once("#ifndef WELKIN_H").expect("a header");
    let contents = opening.split("CONTENTS\n").nth(1).expect("a table of contents");
    let entry = |line: &str| {
        let (name, title) = line.trim_start_matches(" *").trim().strip_prefix('[')?.split_once(']')?;
        Some((name.to_owned(), title.trim().to_owned()))
    };
    let listed: Vec<_> = contents.lines().filter_map(entry).collect();
    let rule = format!(" * {}\n", "=".repeat(100));
    // A banner has a rule at both ends.
    let banners: Vec<_> = sections.split(&rule).skip(1).step_by(2).filter_map(|b| entry(b.lines().next()?)).collect();
    assert!(listed.len() > 30, "{listed:?}");
    assert_eq!(listed, banners);
    let names: std::collections::BTreeSet<_> = listed.iter().map(|(name, _)| name).collect();
    assert_eq!(names.len(), listed.len(), "a name stands for one section");
    for (name, _) in &listed {
        assert_eq!(
            abi::HEADER.matches(&format!("[{name}]")).count(),
            2,
            "[{name}] is in the contents and at its section"
        );
    }
}

/// Both headers, every struct and every INIT macro.
fn every_struct_source() -> String {
    let mut text = String::from("#include \"welkin.h\"\nint main(void)\n{\n");
    for (name, ..) in abi::structs() {
        let upper = name.to_uppercase();
        let value = if abi::has_init(name) { format!(" = {upper}_INIT") } else { String::new() };
        let _ = writeln!(text, "    {{ {name} x{value}; (void)sizeof x; }}");
    }
    text + "    return WK_VERSION_MAJOR < 0;\n}\n"
}

#[test]
fn header_compiles_under_every_standard_without_a_warning() {
    let dir = scratch("standards");
    let strict = ["-Wall", "-Wextra", "-pedantic", "-Werror", "-fsyntax-only", "-I"];
    let mut compilers = vec![("gcc", "g++")];
    if Command::new("clang").arg("--version").output().is_ok() {
        compilers.push(("clang", "clang++"));
    }
    fs::write(dir.join("all.c"), every_struct_source()).unwrap();
    fs::write(dir.join("all.cpp"), every_struct_source()).unwrap();
    for (c, cpp) in compilers {
        for std in ["c99", "c11", "c17"] {
            run(Command::new(c)
                .arg(format!("-std={std}"))
                .args(strict)
                .arg(root().join("include"))
                .arg(dir.join("all.c")));
        }
        for std in ["c++11", "c++17", "c++20"] {
            let hpp = root().join("tests/c/raii.cpp");
            run(Command::new(cpp).arg(format!("-std={std}")).args(strict).arg(root().join("include")).arg(hpp));
            run(Command::new(cpp)
                .arg(format!("-std={std}"))
                .args(strict)
                .arg(root().join("include"))
                .arg(dir.join("all.cpp")));
        }
    }
}

/// Words that other headers define as macros: as nothing, as a type, as a number or as a call.
const FOREIGN_WORDS: &[(&str, &str)] = &[
    ("Qt 5 and 6, qtmetamacros.h and qglobal.h", "signals slots emit foreach forever"),
    (
        "Windows, windows.h with what it includes",
        "near far small hyper pascal cdecl interface FAR NEAR IN OUT OPTIONAL CONST VOID THIS PURE ERROR NO_ERROR DELETE STRICT \
         TRUE FALSE BOOL CALLBACK WINAPI PASCAL CDECL INTERFACE INFINITE IGNORE ABSOLUTE RELATIVE OPAQUE TRANSPARENT WINDING PLANES \
         ALTERNATE DIFFERENCE GetObject DrawText LoadImage CreateWindow SendMessage GetMessage PostMessage CreateFont \
         GetUserName CreateEvent CreateSemaphore GetCurrentTime Yield min max rad1 rad2 grp1 grp2 stat_t",
    ),
    (
        "X11, X.h, Xlib.h, Xutil.h and Xos.h",
        "None Bool Status True False Success Always Complex Convex Nonconvex Unsorted YSorted YXSorted YXBanded CursorShape \
         TileShape StippleShape KeyPress KeyRelease ButtonPress ButtonRelease FocusIn FocusOut Expose GravityNotify Above Below \
         TopIf BottomIf Opposite ControlMask Button1 ParentRelative CopyFromParent AnyKey DestroyAll PseudoColor \
         TrueColor DirectColor GrayScale StaticColor LineSolid CapRound JoinMiter WindingRule EvenOddRule AllValues NoValue \
         XValue YValue WidthValue HeightValue AllTemporary CurrentTime InputOnly InputOutput Absolute Relative Xor Cursor",
    ),
    (
        "C, complex.h, iso646.h and compilers",
        "I complex imaginary and or not xor compl bitand bitor unix linux i386 vax sun",
    ),
    (
        "POSIX and BSD, sysmacros.h, dir.h, term.h",
        "lines columns bell newline erase clear st_atime st_mtime sa_handler",
    ),
    (
        "other libraries",
        "check verify require debug log assert_ text red green blue black white likely unlikely uint byte word",
    ),
];

/// Compiles `text` after the standard's own headers, which use words that C and C++ reserve for them.
fn compile_after_words(dir: &Path, file: &str, compiler: &[&str], words: &str, text: &str) -> Result<(), String> {
    let standard = "#include <stddef.h>\n#include <stdint.h>\n#ifdef __cplusplus\n#include <stdexcept>\n#include <string>\n#endif\n";
    let path = dir.join(file);
    fs::write(&path, format!("{standard}{words}{text}")).expect("the folder is writable");
    let mut command = Command::new(compiler[0]);
    command.args(&compiler[1..]).args(["-Wall", "-Wextra", "-pedantic", "-Werror", "-fsyntax-only", "-I"]);
    let output = command.arg(root().join("include")).arg(&path).output().expect("a compiler");
    match output.status.success() {
        true => Ok(()),
        false => Err(format!("{file}: {}", String::from_utf8_lossy(&output.stderr))),
    }
}

/// Welkin's headers mean the same if they are included after those of a toolkit, a window system or an operating
/// system.
#[test]
fn header_reads_the_same_after_the_macros_of_other_headers() {
    let dir = scratch("foreign_words");
    let all = every_struct_source();
    let in_cpp = all.replacen("welkin.h", "welkin.hpp", 1);
    for (whose, words) in FOREIGN_WORDS {
        let object: String =
            words.split_whitespace().map(|w| format!("#undef {w}\n#define {w} @of_another_header@\n")).collect();
        for (file, compiler, text) in
            [("words.c", ["gcc", "-std=c11"], &all), ("words.cpp", ["g++", "-std=c++17"], &in_cpp)]
        {
            // `and`, `or` and their like are operators in C++, which no macro can take.
            if !words.contains("bitand") || compiler[0] == "gcc" {
                compile_after_words(&dir, file, &compiler, &object, text).unwrap_or_else(|e| panic!("{whose}: {e}"));
            }
        }
    }
    // Compiling fails if a word of the header is a macro; `signals` shows it.
    let signals = "#define signals @\nstruct x { int signals; };\n";
    assert!(compile_after_words(&dir, "caught.c", &["gcc", "-std=c11"], "", signals).is_err());
}

/// The headers of the window system itself, where they are (`libx11-dev`), and C's complex numbers.
#[test]
fn header_reads_the_same_after_real_headers() {
    let dir = scratch("real_headers");
    let c = ["gcc", "-std=c11"];
    let complex = "#include <complex.h>\n#include <iso646.h>\n";
    compile_after_words(&dir, "complex.c", &c, complex, &every_struct_source()).unwrap_or_else(|e| panic!("{e}"));
    let x11 = "#include <X11/Xlib.h>\n#include <X11/Xutil.h>\n#include <X11/Xos.h>\n";
    if compile_after_words(&dir, "probe.c", &c, x11, "int main(void) { return 0; }\n").is_err() {
        println!("skipped: X11's headers are not installed (libx11-dev)");
        return;
    }
    compile_after_words(&dir, "x11.c", &c, x11, &every_struct_source()).unwrap_or_else(|e| panic!("{e}"));
    let hpp = every_struct_source().replacen("welkin.h", "welkin.hpp", 1);
    compile_after_words(&dir, "x11.cpp", &["g++", "-std=c++17"], x11, &hpp).unwrap_or_else(|e| panic!("{e}"));
}

/// A C program that prints each struct's size, alignment, field offsets and sizes, and the bytes of its INIT macro.
fn layout_program() -> String {
    let mut text = String::from("#include \"welkin.h\"\n#include <stdio.h>\n#include <string.h>\n");
    text.push_str("#define ALIGN(T) offsetof(struct { char c; T x; }, x)\n");
    text.push_str("static void hex(const char *name, const void *p, size_t n)\n{\n");
    text.push_str("    const unsigned char *b = (const unsigned char *)p;\n    printf(\"init %s \", name);\n");
    text.push_str("    for (size_t i = 0; i < n; i++) printf(\"%02x\", b[i]);\n    printf(\"\\n\");\n}\n");
    text.push_str("int main(void)\n{\n");
    for (name, _, _, fields) in abi::structs() {
        let _ = writeln!(text, "    printf(\"{name} %zu %zu\\n\", sizeof({name}), (size_t)ALIGN({name}));");
        for (field, ..) in fields {
            let _ = writeln!(
                text,
                "    printf(\"{name}.{field} %zu %zu\\n\", offsetof({name}, {field}), sizeof((({name} *)0)->{field}));"
            );
        }
        if !abi::has_init(name) {
            continue;
        }
        let upper = name.to_uppercase();
        let _ = writeln!(text, "    {{ static const {name} x = {upper}_INIT; hex(\"{name}\", &x, sizeof x); }}");
    }
    text + "    return 0;\n}\n"
}

fn c_view(test: &str) -> String {
    let dir = scratch(test);
    let (source, program) = (dir.join("layout.c"), dir.join("layout"));
    fs::write(&source, layout_program()).unwrap();
    // The header as the sources give it: the committed one is compared with it elsewhere.
    fs::write(dir.join("welkin.h"), abi::HEADER).unwrap();
    run(Command::new("gcc").args(["-std=c99", "-I"]).arg(&dir).arg(&source).arg("-o").arg(&program));
    run(&mut Command::new(program))
}

#[test]
fn c_and_rust_agree_on_every_offset_and_the_committed_list() {
    let mut rust = String::new();
    for (name, size, align, fields) in abi::structs() {
        let _ = writeln!(rust, "{name} {size} {align}");
        let mut end = 0;
        for (field, offset, bytes) in fields {
            let _ = writeln!(rust, "{name}.{field} {offset} {bytes}");
            assert_eq!(end, offset, "{name} has hidden padding before {field}");
            end = offset + bytes;
        }
        assert_eq!(end, size, "{name} has hidden padding at its end");
    }
    let c: String = c_view("layout").lines().filter(|l| !l.starts_with("init ")).map(|l| format!("{l}\n")).collect();
    assert_eq!(c, rust);
    if usize::BITS == 64 {
        compare("tests/abi/layout.txt", &rust);
    }
}

#[test]
fn init_macros_and_init_functions_agree() {
    let macros: BTreeMap<String, String> = c_view("defaults")
        .lines()
        .filter_map(|l| l.strip_prefix("init ")?.split_once(' ').map(|(a, b)| (a.to_owned(), b.to_owned())))
        .collect();
    for (name, size, ..) in abi::structs() {
        let mut bytes = vec![u64::MAX; size.div_ceil(8) + 8];
        if abi::init(name, &mut bytes, size as u32) == welkin::capi::status::WK_ERROR_UNSUPPORTED {
            continue; // embedded structs have no function of their own
        }
        let from_function: String =
            bytes.iter().flat_map(|w| w.to_ne_bytes()).take(size).map(|b| format!("{b:02x}")).collect();
        assert_eq!(macros[name], from_function, "{name}");
        assert_eq!(bytes[size.div_ceil(8)], u64::MAX, "{name}: nothing beyond struct_size is written");
    }
}

#[test]
fn exported_functions_are_the_committed_list() {
    let mut names = abi::functions().to_vec();
    names.sort_unstable();
    let list: String = names.iter().map(|n| format!("{n}\n")).collect();
    compare("tests/abi/symbols.txt", &list);
}
