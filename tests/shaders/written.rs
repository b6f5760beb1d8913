//! Every shader in the languages that drivers get: GLSL of OpenGL 3.3 and of OpenGL ES 3.0 as naga writes it, and
//! SPIR-V with the bounds checks that wgpu requests on a device without robustImageAccess. Rules that can be checked on
//! naga's form are checked on every machine; where glslang and SPIRV-Tools (Debian: glslang-tools, spirv-tools) are
//! installed, they check the written code too.

use std::{collections::BTreeSet, path::PathBuf, process::Command};

use wgpu::naga::{
    Expression as E, Function, Module, ScalarKind, ShaderStage, TypeInner, back,
    proc::{BoundsCheckPolicies, BoundsCheckPolicy},
    valid::{Capabilities, FunctionInfo, ModuleInfo, ValidationFlags, Validator},
};

use super::{all_shaders, text};

fn parsed(name: &str) -> (Module, ModuleInfo) {
    let text = text(name);
    let module = wgpu::naga::front::wgsl::parse_str(&text).unwrap_or_else(|e| panic!("{}", e.emit_to_string(&text)));
    let info = Validator::new(ValidationFlags::all(), Capabilities::all()).validate(&module).expect("a valid shader");
    (module, info)
}

/// Functions and source lines of the expressions for which `fault` returns true, in all shaders.
fn faults(fault: impl Fn(&E, &FunctionInfo, &Module) -> bool) -> BTreeSet<String> {
    let mut all = BTreeSet::new();
    for name in all_shaders() {
        let (module, info) = parsed(&name);
        let text = text(&name);
        let mut look = |function: &Function, info: &FunctionInfo, named: &str| {
            for (handle, _) in function.expressions.iter().filter(|(_, e)| fault(e, info, &module)) {
                let at = function.expressions.get_span(handle).to_range().unwrap_or_default();
                let line = text[..at.start].rfind('\n').map_or(0, |i| i + 1);
                all.insert(format!("{named}: {}", text[line..].lines().next().unwrap_or_default().trim()));
            }
        };
        for (handle, function) in module.functions.iter() {
            look(function, &info[handle], function.name.as_deref().unwrap_or_default());
        }
        for (at, entry) in module.entry_points.iter().enumerate() {
            look(&entry.function, info.get_entry_point(at), &entry.name);
        }
    }
    all
}

/// naga writes a choice by components as `mix`, which accepts integers and booleans only from GLSL 4.50 and ES 3.10 on.
#[test]
fn integers_are_not_chosen_by_components() {
    let found = faults(|e, info, module| match e {
        E::Select { condition, accept, .. } => {
            let by_components = matches!(info[*condition].ty.inner_with(&module.types), TypeInner::Vector { .. });
            by_components && info[*accept].ty.inner_with(&module.types).scalar_kind() != Some(ScalarKind::Float)
        }
        _ => false,
    });
    assert!(found.is_empty(), "{found:#?}");
}

/// naga's bounds check subtracts a signed 1 from the texture's size, in the type of the coordinates
/// (`write_coordinate_one` of its SPIR-V writer): with unsigned coordinates the result is not valid SPIR-V
/// (VUID-VkShaderModuleCreateInfo-pCode-08737).
#[test]
fn texels_are_loaded_by_signed_coordinates() {
    let found = faults(|e, info, module| match e {
        E::ImageLoad { coordinate, .. } => {
            info[*coordinate].ty.inner_with(&module.types).scalar_kind() != Some(ScalarKind::Sint)
        }
        _ => false,
    });
    assert!(found.is_empty(), "{found:#?}");
}

/// Folder for the written shaders, removed when the value is dropped.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("welkin-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&path).expect("the temporary folder is writable");
        Self(path)
    }

    fn write(&self, name: &str, content: &[u8]) -> PathBuf {
        let path = self.0.join(name.replace([':', '/'], "_"));
        std::fs::write(&path, content).expect("the temporary folder is writable");
        path
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// Runs a tool on files, `at_once` in each call; prints that it is skipped where it is not installed.
fn read_by(tool: &str, package: &str, files: &[PathBuf], arguments: &[&str], at_once: usize) {
    if Command::new(tool).arg("--version").output().is_err() {
        println!(
            "1 check skipped: {tool} is not installed (Debian: {package}); {} files are not read by it",
            files.len()
        );
        return;
    }
    let mut refused = Vec::new();
    for some in files.chunks(at_once) {
        let output = Command::new(tool).args(arguments).args(some).output().expect("the tool runs");
        if !output.status.success() {
            let said = [output.stdout, output.stderr].map(|s| String::from_utf8_lossy(&s).into_owned()).concat();
            // glslang prints each file's name before its messages about it.
            let mut file = some[0].display().to_string();
            for line in said.lines() {
                if line.starts_with('/') {
                    file = line.to_owned();
                } else if line.to_lowercase().contains("error: ") && !line.contains("compilation errors") {
                    refused.push(format!("{file}: {line}"));
                }
            }
        }
    }
    println!("{tool} has read {} files", files.len());
    assert!(
        refused.is_empty(),
        "{} refusals of {tool}:\n{}",
        refused.len(),
        refused[..refused.len().min(40)].join("\n")
    );
}

const RESTRICTED: BoundsCheckPolicies = BoundsCheckPolicies {
    index: BoundsCheckPolicy::Restrict,
    buffer: BoundsCheckPolicy::Restrict,
    image_load: BoundsCheckPolicy::Restrict,
    binding_array: BoundsCheckPolicy::Unchecked,
};

#[test]
fn glsl_of_the_oldest_versions_is_read() {
    let folder = Folder::new("glsl");
    let (mut files, mut written, mut beyond_it) = (Vec::new(), BTreeSet::new(), BTreeSet::new());
    for (version, label) in [(back::glsl::Version::Desktop(330), "330"), (back::glsl::Version::new_gles(300), "300es")]
    {
        for name in all_shaders() {
            let (module, info) = parsed(&name);
            // Devices of these versions have no compute shaders.
            for entry in module.entry_points.iter().filter(|e| e.stage != ShaderStage::Compute) {
                let chosen = Some((entry.stage, entry.name.as_str()));
                let (module, info) =
                    back::pipeline_constants::process_overrides(&module, &info, chosen, &Default::default())
                        .expect("constants have defaults");
                let options = back::glsl::Options { version, ..Default::default() };
                let how = back::glsl::PipelineOptions {
                    shader_stage: entry.stage,
                    entry_point: entry.name.clone(),
                    multiview: None,
                };
                let mut out = String::new();
                let writer =
                    back::glsl::Writer::new(&mut out, &module, &info, &options, &how, BoundsCheckPolicies::default());
                let done = writer.and_then(|mut writer| writer.write());
                if let Err(e) = done {
                    // Such devices never get shaders with storage buffers (the lists of precipitation), a run for each
                    // sample or multisampled textures.
                    let beyond = ["BUFFER_STORAGE", "SAMPLE_VARIABLES", "MULTISAMPLED_TEXTURES"];
                    let is_expected = beyond.iter().any(|feature| e.to_string().contains(feature));
                    assert!(is_expected, "{name}, {}, {label}: {e}", entry.name);
                    beyond_it.insert(format!("{name} {label}"));
                    continue;
                }
                if label == "300es" && ["sampler2DMS", "gl_SampleID"].iter().any(|word| out.contains(word)) {
                    beyond_it.insert(format!("{name} {label}"));
                    continue;
                }
                let stage = if entry.stage == ShaderStage::Vertex { "vert" } else { "frag" };
                if written.insert(out.clone()) {
                    files.push(folder.write(&format!("{name}-{}-{label}.{stage}", entry.name), out.as_bytes()));
                }
            }
        }
    }
    println!("{} files are beyond their version: {beyond_it:?}", beyond_it.len());
    assert!(files.len() > 200, "{}", files.len());
    read_by("glslangValidator", "glslang-tools", &files, &[], 40);
}

#[test]
fn spir_v_with_bounds_checks_is_valid() {
    let folder = Folder::new("spirv");
    let mut files = Vec::new();
    for name in all_shaders() {
        let (module, info) = parsed(&name);
        for entry in &module.entry_points {
            let chosen = Some((entry.stage, entry.name.as_str()));
            let (module, info) =
                back::pipeline_constants::process_overrides(&module, &info, chosen, &Default::default())
                    .expect("constants have defaults");
            let options = back::spv::Options {
                bounds_check_policies: RESTRICTED,
                flags: back::spv::WriterFlags::empty(),
                force_loop_bounding: false,
                ..Default::default()
            };
            let how = back::spv::PipelineOptions { shader_stage: entry.stage, entry_point: entry.name.clone() };
            let words = back::spv::write_vec(&module, &info, &options, Some(&how))
                .unwrap_or_else(|e| panic!("{name}, {}: {e}", entry.name));
            let bytes: Vec<u8> = words.iter().flat_map(|w| w.to_le_bytes()).collect();
            files.push(folder.write(&format!("{name}-{}.spv", entry.name), &bytes));
        }
    }
    assert!(files.len() > 150, "{}", files.len());
    read_by("spirv-val", "spirv-tools", &files, &["--target-env", "vulkan1.1"], 1);
}

/// Pipelines that test for equal depth draw with other programs than those that wrote the depth. So each vertex shader
/// of a full screen declares its position invariant, which makes it the same in all of them; no fragment shader's input
/// may be declared so, since OpenGL ES refuses what naga writes for it.
#[test]
fn positions_of_full_screens_are_invariant() {
    use wgpu::naga::{Binding, BuiltIn};
    let mut found = 0;
    for name in all_shaders() {
        let (module, _) = parsed(&name);
        let positions = |ty, binding: &Option<Binding>| match &module.types[ty].inner {
            TypeInner::Struct { members, .. } => members.iter().filter_map(|m| m.binding.clone()).collect(),
            _ => binding.iter().cloned().collect::<Vec<_>>(),
        };
        let is_invariant = |of: &[Binding]| of.contains(&Binding::BuiltIn(BuiltIn::Position { invariant: true }));
        for entry in &module.entry_points {
            let read: Vec<_> = entry.function.arguments.iter().flat_map(|a| positions(a.ty, &a.binding)).collect();
            assert!(!is_invariant(&read), "{name}: {} reads an invariant position", entry.name);
            if entry.name == "fullscreen_vertex" {
                let result = entry.function.result.as_ref().expect("a result");
                assert!(is_invariant(&positions(result.ty, &result.binding)), "{name}");
                found += 1;
            }
        }
    }
    assert!(found > 40, "{found}");
}
