//! Damaged files of heights: each is read, or refused with the place of the fault; heights that are read are
//! consistent.

use welkin::heights::{HeightSettings, RawHeights};
use welkin_support::{
    accept,
    fuzz::{
        dice::Dice,
        targets::{height_files, heights_by, raw_layouts},
        texts::damage,
    },
};

/// Words in place of a header's or a chunk's numbers.
fn damage_words(dice: &mut Dice, file: &mut [u8]) {
    for _ in 0..dice.below(3) {
        let at = dice.below(file.len().min(160));
        let word: u32 = match dice.below(4) {
            0 => dice.below(20) as u32,
            1 => 1 << dice.below(32),
            2 => u32::MAX - dice.below(3) as u32,
            _ => dice.bits() as u32,
        };
        let bytes = if dice.one_in(2) { word.to_le_bytes() } else { word.to_be_bytes() };
        if let Some(place) = file.get_mut(at..at + 4) {
            place.copy_from_slice(&bytes);
        }
    }
}

/// Corrects the checksums of the chunks, so that damage within a PNG reaches the decoder.
fn mend_checksums(file: &mut [u8]) {
    let mut at = 8;
    while let Some(head) = file.get(at..at + 8) {
        let length = u32::from_be_bytes([head[0], head[1], head[2], head[3]]) as usize;
        let Some(body) = file.get(at + 4..at + 8 + length) else { return };
        let step = |sum: u32, _| (sum >> 1) ^ if sum & 1 == 1 { 0xedb8_8320 } else { 0 };
        let sum = !body.iter().fold(u32::MAX, |sum, byte| (0..8).fold(sum ^ u32::from(*byte), step));
        let Some(place) = file.get_mut(at + 8 + length..at + 12 + length) else { return };
        place.copy_from_slice(&sum.to_be_bytes());
        at += 12 + length;
    }
}

#[test]
fn damaged_height_files_are_read_or_refused_by_place() {
    let times = if accept() { 40_000 } else { 4000 };
    let raw = raw_layouts().into_iter().map(|(layout, file)| (Some(layout), file));
    let files: Vec<(Option<RawHeights>, Vec<u8>)> =
        height_files().into_iter().map(|file| (None, file)).chain(raw).collect();
    assert!(files.len() > 10);
    let mut dice = Dice::new(44);
    for (i, (layout, whole)) in files.iter().enumerate() {
        let mut accepted = 0;
        for _ in 0..times {
            let mut file = whole.clone();
            damage(&mut dice, &mut file);
            damage_words(&mut dice, &mut file);
            if file.starts_with(b"\x89PNG") && !dice.one_in(4) {
                mend_checksums(&mut file);
            }
            let mut settings = HeightSettings { raw: *layout, ..Default::default() };
            if dice.one_in(2) {
                settings.no_data = Some(dice.float());
            }
            accepted += usize::from(heights_by(&file, &settings));
        }
        println!("file {i}, {} bytes: {accepted} of {times} accepted", whole.len());
        assert!(accepted > times / 20 && accepted < times * 19 / 20, "file {i}: {accepted} of {times}");
    }
}
