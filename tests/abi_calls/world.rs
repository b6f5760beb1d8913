//! One live object of each kind, and small tools.

use std::ffi::c_void;
use std::ptr::null_mut;
use std::sync::atomic::{AtomicU64, Ordering};

use welkin::capi::{abi, context::*, device::*, status::*, texture::*, timeline::*, view::*};
use welkin_support::refusals;

/// A device on the noop backend with a context, a view and a texture.
pub struct World {
    pub device: *mut wk_device,
    pub context: *mut wk_context,
    pub view: *mut wk_view,
    pub texture: *mut wk_texture,
}

/// Returns the thread's last message, and checks that the header has the field that it names.
pub fn message() -> String {
    assert_eq!(refusals::field_fault(), None);
    refusals::message()
}

/// Returns the struct with every field at its default.
pub fn init<T>(name: &str) -> T {
    let mut bytes = vec![0_u64; size_of::<T>().div_ceil(8)];
    assert_eq!(abi::init(name, &mut bytes, size_of::<T>() as u32), WK_OK, "{}", message());
    // SAFETY: `bytes` holds a `T`, for which every bit pattern is valid.
    unsafe { bytes.as_ptr().cast::<T>().read() }
}

impl World {
    pub fn new() -> Self {
        let mut world = Self { device: null_mut(), context: null_mut(), view: null_mut(), texture: null_mut() };
        // SAFETY: pointers to live locals.
        unsafe {
            let desc = wk_device_desc { backends: WK_BACKEND_NOOP, ..init("wk_device_desc") };
            assert_eq!(wk_device_create(&desc, &mut world.device), WK_OK, "{}", message());
            let desc = init::<wk_context_desc>("wk_context_desc");
            assert_eq!(wk_context_create(world.device, &desc, &mut world.context), WK_OK, "{}", message());
            let desc = init::<wk_view_desc>("wk_view_desc");
            assert_eq!(wk_view_create(world.context, &desc, &mut world.view), WK_OK, "{}", message());
            let desc = wk_texture_desc { width: 8, height: 8, ..init("wk_texture_desc") };
            assert_eq!(wk_texture_create(world.device, &desc, &mut world.texture), WK_OK, "{}", message());
        }
        world
    }
}

impl Drop for World {
    fn drop(&mut self) {
        // SAFETY: the handles are live, or NULL.
        unsafe {
            assert_eq!(wk_view_destroy(self.view), WK_OK);
            assert_eq!(wk_context_destroy(self.context), WK_OK);
            assert_eq!(wk_texture_destroy(self.texture), WK_OK);
            assert_eq!(wk_device_destroy(self.device), WK_OK);
        }
    }
}

/// Updates a context until no steps remain.
pub fn update(context: *mut wk_context, time_s: f64) {
    // SAFETY: every caller has a live context.
    let status = (0..1_000_000).map(|_| unsafe { wk_context_update(context, time_s) }).find(|s| *s != WK_PENDING);
    assert_eq!(status, Some(WK_OK), "{}", message());
}

/// Returns a changed saved state with a correct checksum.
pub fn resealed(state: &str) -> String {
    let body = state.split_once('\n').unwrap().1;
    let fold = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
    format!("welkin state 2 {:016x}\n{body}", body.bytes().fold(0xcbf2_9ce4_8422_2325, fold))
}

/// A frame number that no frame had before.
pub fn next_frame() -> u64 {
    static NEXT: AtomicU64 = AtomicU64::new(0);
    NEXT.fetch_add(1, Ordering::Relaxed)
}

/// Aligned memory for any struct of the header.
#[derive(Clone)]
pub struct Bytes {
    words: Vec<u64>,
    pub size: usize,
}

impl Bytes {
    /// The struct `name` at its defaults, with `extra` zero bytes behind it.
    pub fn of(name: &str, extra: usize) -> Self {
        let (_, size, ..) = abi::structs().into_iter().find(|s| s.0 == name).unwrap_or_else(|| panic!("{name}"));
        let mut words = vec![0_u64; (size + extra).div_ceil(8)];
        assert_eq!(abi::init(name, &mut words, size as u32), WK_OK, "{}", message());
        Self { words, size }
    }

    pub fn ptr(&mut self) -> *mut c_void {
        self.words.as_mut_ptr().cast()
    }

    /// Writes `value` at a byte offset.
    pub fn put<T>(&mut self, offset: usize, value: T) {
        assert!(offset + size_of::<T>() <= self.words.len() * 8);
        // SAFETY: inside the words, unaligned write.
        unsafe { self.words.as_mut_ptr().cast::<u8>().add(offset).cast::<T>().write_unaligned(value) };
    }

    pub fn words(&self) -> &[u64] {
        &self.words
    }
}
