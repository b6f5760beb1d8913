//! Functions whose last bits depend on the platform: rooms that step states do not call any.

use crate::{files, read, root};

/// Rooms that step states or compute the inputs of a step.
const SAME_BITS: [&str; 17] = [
    "almanac",
    "chance",
    "context",
    "falling",
    "flow",
    "ground",
    "heights",
    "planet",
    "sea",
    "snowpack",
    "soil",
    "surroundings",
    "terrain",
    "weather",
    "wind",
    "world",
    "scene",
];

/// Files of these rooms that only draw, or compute light, which is rounded before a state depends on it.
const LIGHT_ALONE: [&str; 6] = [
    "scene/camera.rs",
    "scene/depth.rs",
    "scene/light.rs",
    "planet/spectral.rs",
    "planet/spectra.rs",
    "planet/model.rs",
];

/// Functions of the standard library and of glam whose last bits depend on the platform.
const PLATFORMS: [&str; 30] = [
    "sin(",
    "cos(",
    "tan(",
    "asin(",
    "acos(",
    "atan(",
    "atan2(",
    "sin_cos(",
    "exp(",
    "exp2(",
    "exp_m1(",
    "ln(",
    "ln_1p(",
    "log10(",
    "log2(",
    "log(",
    "powf(",
    "cbrt(",
    "hypot(",
    "sinh(",
    "cosh(",
    "tanh(",
    "mul_add(",
    "from_rotation_x(",
    "from_rotation_y(",
    "from_rotation_z(",
    "from_axis_angle(",
    "from_angle(",
    "angle_between(",
    "angle_to(",
];

#[test]
fn code_that_computes_states_calls_mathematical_functions_of_libm_only() {
    let mut found = Vec::new();
    for (room, path) in files("src", "rs") {
        let name = path.strip_prefix(root().join("src")).expect("below it").to_string_lossy().replace('\\', "/");
        let tests = name.ends_with("tests.rs") || name.contains("/tests/");
        if !SAME_BITS.contains(&room.as_str()) || LIGHT_ALONE.contains(&name.as_str()) || tests {
            continue;
        }
        let text = read(&path);
        let code = text.split("mod tests {").next().unwrap_or_default();
        for (number, line) in code.lines().enumerate().filter(|(_, line)| !line.trim_start().starts_with("//")) {
            let line = line.replace("libm::", "libm ");
            let calls = |call: &&&str| line.contains(&format!(".{call}")) || line.contains(&format!("::{call}"));
            if let Some(call) = PLATFORMS.iter().find(calls) {
                found.push(format!("src/{name}:{}: {call}", number + 1));
            }
        }
    }
    assert!(found.is_empty(), "other machines find other bits; use libm:\n{}", found.join("\n"));
}
