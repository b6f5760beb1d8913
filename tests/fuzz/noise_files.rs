//! Damaged files of noise: each is read or refused; noise that is read is consistent.

use welkin::noise::{NoiseImage, NoiseSettings};
use welkin_support::{
    accept,
    fuzz::{dice::Dice, texts::damage},
};

/// A number as damaged headers hold it.
fn header_word(dice: &mut Dice) -> u32 {
    match dice.below(4) {
        0 => dice.below(20) as u32,
        1 => 1 << dice.below(32),
        2 => u32::MAX - dice.below(3) as u32,
        _ => dice.bits() as u32,
    }
}

#[test]
fn damaged_noise_files_are_read_or_refused_by_name() {
    let times = if accept() { 400_000 } else { 40_000 };
    let settings = NoiseSettings { frequency: [2; 3], ..Default::default() };
    let image = |size| NoiseImage::generate(size, &settings).expect("good settings");
    let files: Vec<_> =
        [[16, 8, 1], [8, 8, 8]].map(image).iter().flat_map(|i| [i.to_dds(), i.to_dds_dx10(), i.to_ktx2()]).collect();
    // With the header of older programs: luminance of 8 bits.
    let mut older = files[2].clone();
    older.drain(128..148);
    older[80..92].copy_from_slice(&[0, 0, 2, 0, 0, 0, 0, 0, 8, 0, 0, 0]);
    let files = [files, vec![older]].concat();
    let mut dice = Dice::new(14);
    let mut accepted = 0;
    for i in 0..times {
        let mut file = files[i % files.len()].clone();
        damage(&mut dice, &mut file);
        // Fields of the header and of the index.
        for _ in 0..dice.below(3) {
            let at = 4 * dice.below(file.len().min(200) / 4);
            if let Some(word) = file.get_mut(at..at + 4) {
                word.copy_from_slice(&header_word(&mut dice).to_le_bytes());
            }
        }
        match NoiseImage::from_bytes(&file) {
            Ok(read) => {
                accepted += 1;
                for (level, bytes) in (0..).zip(read.levels()) {
                    let texels: u32 = read.size_of_level(level).iter().product();
                    assert_eq!(bytes.len(), texels as usize, "file {i}, level {level}");
                }
                let bytes: usize = read.levels().iter().map(Vec::len).sum();
                assert!(bytes <= 2 * file.len(), "file {i}: {bytes} of {}", file.len());
            }
            Err(e) => {
                let text = e.to_string();
                assert!(["DDS", "KTX2"].iter().any(|name| text.contains(name)), "file {i}: {text}");
            }
        }
    }
    println!("{accepted} of {times} accepted");
    assert!(accepted > times / 20 && accepted < times * 9 / 10, "{accepted} of {times}");
}
