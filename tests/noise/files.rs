//! Noise in files: written noise is read back, and files that are no noise are refused by name.

use welkin::noise::{NoiseImage, NoiseKind, NoiseSettings};
use welkin::{Error, Status};

fn image(size: [u32; 3]) -> NoiseImage {
    let settings = NoiseSettings { kind: NoiseKind::Gradient, frequency: [2; 3], octaves: 2, ..Default::default() };
    NoiseImage::generate(size, &settings).unwrap()
}

fn files(of: &NoiseImage) -> [Vec<u8>; 3] {
    [of.to_dds(), of.to_dds_dx10(), of.to_ktx2()]
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

#[test]
fn other_programs_read_what_is_written() {
    for size in [[32, 8, 1], [16, 8, 8]] {
        let image = image(size);
        let is_volume = size[2] > 1;
        for (file, is_dx10) in [(image.to_dds(), false), (image.to_dds_dx10(), true)] {
            let dds = ddsfile::Dds::read(&mut &file[..]).unwrap();
            assert_eq!([dds.get_width(), dds.get_height(), dds.get_depth()], size);
            assert_eq!(dds.get_num_mipmap_levels() as usize, image.levels().len());
            let format = dds.get_dxgi_format();
            assert_eq!(format, is_dx10.then_some(ddsfile::DxgiFormat::R8_UNorm));
            // The crate does not read masks of luminance, and so does not know L8.
            let pixel = &dds.header.spf;
            let is_l8 = pixel.flags.contains(ddsfile::PixelFormatFlags::LUMINANCE) && pixel.rgb_bit_count == Some(8);
            assert_ne!(is_l8, is_dx10);
            assert_eq!(dds.header.caps2.contains(ddsfile::Caps2::VOLUME), is_volume);
            assert_eq!(dds.data, image.levels().concat());
        }

        let file = image.to_ktx2();
        let ktx = ktx2::Reader::new(&file[..]).unwrap();
        let header = ktx.header();
        let depth = if is_volume { size[2] } else { 0 };
        assert_eq!([header.pixel_width, header.pixel_height, header.pixel_depth], [size[0], size[1], depth]);
        assert_eq!(header.format, Some(ktx2::Format::R8_UNORM));
        assert_eq!((header.face_count, header.layer_count, header.type_size), (1, 0, 1));
        assert_eq!(ktx.writer().map(|name| name.trim_end_matches(char::from(0))), Some("Welkin"));
        assert_eq!(ktx.transfer_function(), Some(ktx2::TransferFunction::Linear));
        let basic = ktx.basic_dfd().expect("a basic block of the data format");
        assert_eq!((basic.bytes_planes[0], basic.sample_information.len()), (1, 1));
        let levels: Vec<_> = ktx.levels().map(|level| level.data.to_vec()).collect();
        assert_eq!(levels, image.levels());
    }
}

/// A file with words of 32 bits changed.
fn changed(file: &[u8], words: &[(usize, u32)]) -> Vec<u8> {
    let mut file = file.to_vec();
    words.iter().for_each(|(at, word)| file[*at..at + 4].copy_from_slice(&word.to_le_bytes()));
    file
}

/// A DDS file with the shorter header of older programs.
fn legacy(image: &NoiseImage, flags: u32, masks: [u32; 2]) -> Vec<u8> {
    let file = changed(&image.to_dds_dx10(), &[(80, flags), (84, 0), (88, 8), (92, masks[0]), (104, masks[1])]);
    [&file[..128], &file[148..]].concat()
}

#[test]
fn files_of_other_programs_are_read() {
    let (plane, volume) = (image([16, 8, 1]), image([8, 16, 8]));
    let reads = |file: &[u8], image: &NoiseImage| assert_eq!(NoiseImage::from_bytes(file).as_ref(), Ok(image));
    for image in [&plane, &volume] {
        reads(&legacy(image, 0x2, [0, 0xff]), image);
        reads(&legacy(image, 0x2_0000, [0xff, 0]), image);
        reads(&changed(&image.to_dds_dx10(), &[(128, 65)]), image);
        // A header as NVIDIA's exporter writes it.
        reads(&changed(&image.to_dds_dx10(), &[(132, 0)]), image);
        reads(&[&image.to_dds()[..], b"more"].concat(), image);
        reads(&changed(&image.to_ktx2(), &[(32, 1)]), image);
    }
    // A single level, with and without the field that says so, as in files of older programs.
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
fn bad_noise_is_refused_by_the_name_of_its_field() {
    let image = image([16, 8, 8]);
    let (dds, ktx) = (image.to_dds_dx10(), image.to_ktx2());
    let refused = |file: Vec<u8>, status: Status, field: &str| {
        let e: Error = NoiseImage::from_bytes(&file).unwrap_err();
        assert!(e.status == status && e.field() == Some(field), "{field}: {:?} {e}", e.status);
    };
    let cc = |name: &[u8; 4]| u32::from_le_bytes(*name);
    let foreign = Status::Unsupported;
    refused(changed(&dds, &[(80, 4), (84, cc(b"DXT1"))]), foreign, "ddspf.dwFourCC");
    refused(changed(&dds, &[(80, 0x41), (88, 32)]), foreign, "ddspf");
    refused(changed(&legacy(&image, 0x2_0000, [0xffff, 0]), &[(88, 16)]), foreign, "ddspf");
    refused(changed(&dds, &[(112, 0xfe00)]), foreign, "dwCaps2");
    refused(changed(&dds, &[(4, 123)]), Status::Parse, "dwSize");
    refused(changed(&dds, &[(76, 0)]), Status::Parse, "ddspf.dwSize");
    refused(changed(&dds, &[(12, 0)]), Status::Parse, "dwHeight");
    refused(changed(&dds, &[(24, 0)]), Status::Parse, "dwDepth");
    refused(changed(&dds, &[(28, 6)]), Status::Parse, "dwMipMapCount");
    refused(changed(&dds, &[(12, u32::MAX), (16, u32::MAX), (24, u32::MAX)]), foreign, "dwWidth");
    refused(changed(&dds, &[(128, 28)]), foreign, "dxgiFormat");
    refused(changed(&dds, &[(132, 2)]), foreign, "resourceDimension");
    refused(changed(&dds, &[(136, 4)]), foreign, "miscFlag");
    refused(changed(&dds, &[(140, 2)]), foreign, "arraySize");

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
