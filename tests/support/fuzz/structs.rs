//! Structs of the header with some fields changed at random, and the lists they point to.

use std::ffi::{CString, c_void};

use welkin::capi::{abi, status::*};

use super::dice::Dice;

/// Maximum number of elements in a list passed to a call.
pub const MOST: u32 = 5;
/// Maximum stride for which lists have room, in bytes.
const ROOM: usize = 4096;

/// A struct of the header, or a list of them, in memory of its own; the data it points to lives as long.
pub struct Struct {
    words: Vec<u64>,
    name: &'static str,
    stride: usize,
    texts: Vec<CString>,
    lists: Vec<Struct>,
    numbers: Vec<f32>,
}

/// The struct's name as in the library, and its size.
fn known(name: &str) -> (&'static str, usize) {
    let found = abi::structs().into_iter().find(|s| s.0 == name).unwrap_or_else(|| panic!("no struct {name}"));
    (found.0, found.1)
}

impl Struct {
    /// One struct with its defaults, or zeros if it has none.
    pub fn plain(name: &str) -> Self {
        Self::list(name, 1)
    }

    /// A list of structs with their defaults.
    pub fn list(name: &str, count: u32) -> Self {
        let (name, size) = known(name);
        let stride = size.next_multiple_of(8);
        let words = vec![0_u64; ((count as usize).max(1) * stride + ROOM) / 8];
        let mut made = Self { words, name, stride, texts: vec![], lists: vec![], numbers: vec![] };
        if abi::has_init(name) {
            for i in 0..count as usize {
                let at = i * stride / 8;
                assert_eq!(abi::init(name, &mut made.words[at..at + stride / 8], size as u32), WK_OK);
            }
        }
        made
    }

    /// One struct, with each field changed at random with a probability of one in `rarity`.
    pub fn random(dice: &mut Dice, name: &str, rarity: usize) -> Self {
        let mut made = Self::plain(name);
        made.change(dice, 0, rarity);
        made
    }

    /// A list of up to [`MOST`] such structs, and their number.
    pub fn random_list(dice: &mut Dice, name: &str, rarity: usize) -> (Self, u32) {
        let count = dice.below(MOST as usize + 1) as u32;
        let mut made = Self::list(name, MOST);
        for i in 0..count as usize {
            made.change(dice, i, rarity);
        }
        (made, count)
    }

    fn change(&mut self, dice: &mut Dice, element: usize, rarity: usize) {
        let (start, name) = (element * self.stride, self.name);
        for (_, _, offset, wide, count) in abi::floats().into_iter().filter(|f| f.0 == name) {
            for i in 0..count {
                if dice.one_in(rarity * count) {
                    let value = dice.float();
                    if wide {
                        self.put(start + offset + 8 * i, value)
                    } else {
                        self.put(start + offset + 4 * i, value as f32)
                    };
                }
            }
        }
        for (_, field, offset, bytes, count) in abi::integers().into_iter().filter(|f| f.0 == name) {
            // Counts and strides belong to their lists; images of other devices belong to their hosts.
            let own = field.ends_with("_count") || field.ends_with("_stride") || field == "opengl";
            for i in 0..count {
                if !own && dice.one_in(rarity * count) {
                    let value = dice.whole();
                    let at = start + offset + bytes * i;
                    match bytes {
                        1 => self.put(at, value as u8),
                        2 => self.put(at, value as u16),
                        4 => self.put(at, value as u32),
                        _ => self.put(at, value),
                    }
                }
            }
        }
        if dice.one_in(40) && self.name.starts_with("wk_") && abi::has_init(self.name) {
            let wrong = dice.pick(&[0_u32, 8, 16, 24, 40, 64, 100, 1 << 20]);
            self.put(start, wrong);
        }
    }

    /// Writes a field's bytes.
    pub fn put<T>(&mut self, offset: usize, value: T) {
        assert!(offset + size_of::<T>() <= self.words.len() * 8);
        // SAFETY: inside the words, unaligned write.
        unsafe { self.words.as_mut_ptr().cast::<u8>().add(offset).cast::<T>().write_unaligned(value) };
    }

    fn offset(&self, field: &str) -> usize {
        let fields = abi::structs().into_iter().find(|s| s.0 == self.name).expect("known").3;
        fields.iter().find(|f| f.0 == field).unwrap_or_else(|| panic!("no {}.{field}", self.name)).1
    }

    /// Sets a field by its name.
    pub fn set<T>(&mut self, field: &str, value: T) {
        let offset = self.offset(field);
        self.put(offset, value);
    }

    /// Points `field` to a text that lives as long as this struct.
    pub fn set_text(&mut self, field: &str, text: &str) {
        let text = CString::new(text.replace('\0', "")).expect("no zeros");
        self.set(field, text.as_ptr());
        self.texts.push(text);
    }

    /// Points `field` to another struct, which this one keeps.
    pub fn set_struct(&mut self, field: &str, mut other: Self) {
        self.set(field, other.ptr());
        self.lists.push(other);
    }

    /// Points `field` to numbers, which this struct keeps.
    pub fn set_numbers(&mut self, field: &str, numbers: Vec<f32>) {
        self.set(field, numbers.as_ptr());
        self.numbers = numbers;
    }

    pub fn ptr(&mut self) -> *mut c_void {
        self.words.as_mut_ptr().cast()
    }

    /// Bytes from one element to the next.
    pub fn stride(&self) -> u32 {
        self.stride as u32
    }

    /// Size of one element.
    pub fn size(&self) -> u32 {
        known(self.name).1 as u32
    }

    /// Names of the struct's floats that are not finite.
    pub fn not_finite(&self) -> Vec<&'static str> {
        let bytes: &[u8] = bytemuck::cast_slice(&self.words);
        let mut found = vec![];
        for (_, field, offset, wide, count) in abi::floats().into_iter().filter(|f| f.0 == self.name) {
            for i in 0..count {
                let value = if wide {
                    f64::from_ne_bytes(bytes[offset + 8 * i..][..8].try_into().expect("eight bytes"))
                } else {
                    f64::from(f32::from_ne_bytes(bytes[offset + 4 * i..][..4].try_into().expect("four bytes")))
                };
                if !value.is_finite() {
                    found.push(field);
                }
            }
        }
        found
    }
}
