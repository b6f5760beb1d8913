//! Files of noise read by OpenSceneGraph's own reader, as an OpenSceneGraph host would load them.
#![cfg(target_os = "linux")]

use std::{path::Path, process::Command};

use welkin::noise::{NoiseImage, NoiseSettings};

/// Hash of bytes by FNV-1a, the same as in osg_reader.cpp.
fn hash(bytes: impl Iterator<Item = u8>) -> u64 {
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3))
}

#[test]
fn openscenegraph_reads_planes_and_volumes_to_the_last_texel() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let reader = folder.join("osg_reader");
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/noise/osg_reader.cpp");
    let mut compile = Command::new("c++");
    compile.arg(source).arg("-o").arg(&reader).args(["-losgDB", "-losg", "-lOpenThreads"]);
    let built = compile.output().expect("a C++ compiler is installed");
    let said = String::from_utf8_lossy(&built.stderr);
    assert!(built.status.success(), "install libopenscenegraph-dev: {said}");
    for size in [[64, 32, 1], [16, 8, 8]] {
        let settings = NoiseSettings { frequency: [2; 3], octaves: 2, ..NoiseSettings::default() };
        let image = NoiseImage::generate(size, &settings).unwrap();
        let path = folder.join(format!("osg_{}.dds", size[2]));
        std::fs::write(&path, image.to_dds()).unwrap();
        let output = Command::new(&reader).arg(&path).output().unwrap();
        let [w, h, d] = size;
        let (levels, texels) = (image.levels().len(), hash(image.levels().concat().into_iter()));
        // 0x1909 is GL_LUMINANCE.
        let expected = format!("{w} x {h} x {d} format 0x1909 levels {levels} hash {texels:016x}");
        let said = String::from_utf8_lossy(&output.stdout);
        assert_eq!(said.trim(), expected, "{}", String::from_utf8_lossy(&output.stderr));
    }
}
