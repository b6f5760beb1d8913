//! Noise in files: what is written comes back, and what is no noise is refused by name.

use welkin::noise::{NoiseImage, NoiseKind, NoiseSettings};
use welkin::{Error, Status};

fn image(size: [u32; 3]) -> NoiseImage {
    let settings = NoiseSettings { kind: NoiseKind::Gradient, frequency: [2; 3], octaves: 2, ..Default::default() };
    NoiseImage::generate(size, &settings).unwrap()
}

fn files(of: &NoiseImage) -> [Vec<u8>; 2] {
    [of.to_dds(), of.to_ktx2()]
}

#[test]
fn what_is_written_is_read_byte_for_byte() {
    for size in [[16, 8, 1], [8, 8, 8], [32, 8, 16]] {
        let image = image(size);
        for file in files(&image) {
            assert_eq!(NoiseImage::from_bytes(&file).unwrap(), image);
        }
    }
    let path = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("noise.ktx2");
    std::fs::write(&path, image([8, 8, 8]).to_ktx2()).unwrap();
    assert_eq!(NoiseImage::load(&path).unwrap(), image([8, 8, 8]));
    let missing = NoiseImage::load(path.with_extension("none")).unwrap_err();
    assert!(missing.status == Status::Io && missing.to_string().contains("noise.none"), "{missing}");
}

/// A file with words of 32 bits changed.
fn changed(file: &[u8], words: &[(usize, u32)]) -> Vec<u8> {
    let mut file = file.to_vec();
    words.iter().for_each(|(at, word)| file[*at..at + 4].copy_from_slice(&word.to_le_bytes()));
    file
}

/// A DDS file with the longer header.
fn dx10(image: &NoiseImage, format: u32, dimension: u32, misc: u32, layers: u32) -> Vec<u8> {
    let file = changed(&image.to_dds(), &[(80, 4), (84, u32::from_le_bytes(*b"DX10")), (88, 0)]);
    let more = [format, dimension, misc, layers, 0].map(u32::to_le_bytes).concat();
    [&file[..128], &more, &file[128..]].concat()
}

#[test]
fn files_of_other_programs_are_read() {
    let (plane, volume) = (image([16, 8, 1]), image([8, 16, 8]));
    let reads = |file: &[u8], image: &NoiseImage| assert_eq!(NoiseImage::from_bytes(file).as_ref(), Ok(image));
    for image in [&plane, &volume] {
        let alpha = changed(&image.to_dds(), &[(80, 2), (92, 0), (104, 0xff)]);
        reads(&alpha, image);
        let dimension = if image.size()[2] == 1 { 3 } else { 4 };
        reads(&dx10(image, 61, dimension, 0, 1), image);
        reads(&dx10(image, 65, dimension, 0, 1), image);
        reads(&[&image.to_dds()[..], b"more"].concat(), image);
        reads(&changed(&image.to_ktx2(), &[(32, 1)]), image);
    }
    // One level alone, in words that say so and in those of older programs.
    for levels in [0, 1] {
        let one = NoiseImage::from_bytes(&changed(&plane.to_dds(), &[(28, levels)])[..128 + 128]).unwrap();
        assert_eq!((one.levels(), one.size()), (&plane.levels()[..1], plane.size()));
        let one = NoiseImage::from_bytes(&changed(&plane.to_ktx2(), &[(40, levels)])).unwrap();
        assert_eq!(one.levels(), &plane.levels()[..1]);
    }
}

#[test]
fn every_cut_is_refused() {
    for size in [[8, 8, 1], [8, 8, 8]] {
        for file in files(&image(size)) {
            for length in 0..file.len() {
                let e = NoiseImage::from_bytes(&file[..length]).unwrap_err();
                let (is_cut, is_foreign) = (e.to_string().contains("cut short"), e.to_string().contains("neither"));
                assert!(is_cut || (length < 12 && is_foreign), "{length}: {e}");
            }
        }
    }
}

#[test]
fn what_is_no_noise_is_refused_by_the_name_of_its_field() {
    let image = image([16, 8, 8]);
    let (dds, ktx) = (image.to_dds(), image.to_ktx2());
    let refused = |file: Vec<u8>, status: Status, field: &str| {
        let e: Error = NoiseImage::from_bytes(&file).unwrap_err();
        assert!(e.status == status && e.field() == Some(field), "{field}: {:?} {e}", e.status);
    };
    let cc = |name: &[u8; 4]| u32::from_le_bytes(*name);
    let foreign = Status::Unsupported;
    refused(changed(&dds, &[(80, 4), (84, cc(b"DXT1"))]), foreign, "ddspf.dwFourCC");
    refused(changed(&dds, &[(80, 0x41), (88, 32)]), foreign, "ddspf");
    refused(changed(&dds, &[(88, 16)]), foreign, "ddspf");
    refused(changed(&dds, &[(112, 0xfe00)]), foreign, "dwCaps2");
    refused(changed(&dds, &[(4, 123)]), Status::Parse, "dwSize");
    refused(changed(&dds, &[(76, 0)]), Status::Parse, "ddspf.dwSize");
    refused(changed(&dds, &[(12, 0)]), Status::Parse, "dwHeight");
    refused(changed(&dds, &[(24, 0)]), Status::Parse, "dwDepth");
    refused(changed(&dds, &[(28, 6)]), Status::Parse, "dwMipMapCount");
    refused(changed(&dds, &[(12, u32::MAX), (16, u32::MAX), (24, u32::MAX)]), foreign, "dwWidth");
    refused(dx10(&image, 28, 4, 0, 1), foreign, "dxgiFormat");
    refused(dx10(&image, 61, 2, 0, 1), foreign, "resourceDimension");
    refused(dx10(&image, 61, 4, 4, 1), foreign, "miscFlag");
    refused(dx10(&image, 61, 4, 0, 2), foreign, "arraySize");

    refused(changed(&ktx, &[(12, 37)]), foreign, "vkFormat");
    refused(changed(&ktx, &[(20, 0)]), Status::Parse, "pixelWidth");
    refused(changed(&ktx, &[(20, 1 << 28)]), foreign, "pixelWidth");
    refused(changed(&ktx, &[(32, 2)]), foreign, "layerCount");
    refused(changed(&ktx, &[(36, 6)]), foreign, "faceCount");
    refused(changed(&ktx, &[(40, 6)]), Status::Parse, "levelCount");
    refused(changed(&ktx, &[(44, 2)]), foreign, "supercompressionScheme");
    refused(changed(&ktx, &[(80 + 8, 5)]), Status::Parse, "levels[0].byteLength");
    for at in [80, 84] {
        let e = NoiseImage::from_bytes(&changed(&ktx, &[(at, u32::MAX)])).unwrap_err();
        assert!(e.to_string().contains("cut short"), "{e}");
    }
    for other in [&b"\x89PNG\r\n\x1a\n"[..], b"", b"\xabKTX 11\xbb\r\n\x1a\n"] {
        assert!(NoiseImage::from_bytes(other).unwrap_err().to_string().contains("like neither"));
    }
}
