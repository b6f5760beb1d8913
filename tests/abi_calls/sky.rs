//! The sky's tables built ahead of time: progress, abort, files. On a device that computes.

use std::ffi::{CStr, CString, c_char, c_void};
use std::path::{Path, PathBuf};
use std::ptr::null_mut;
use std::sync::Mutex;

use welkin::capi::{context::*, device::*, frame::*, sky::*, status::*, view::*};

use super::world::{init, message};

static LOG: Mutex<Vec<String>> = Mutex::new(Vec::new());

unsafe extern "C" fn on_log(_: *mut c_void, _: wk_log_level, text: *const c_char) {
    // SAFETY: the function type promises a string.
    LOG.lock().unwrap().push(unsafe { CStr::from_ptr(text) }.to_string_lossy().into_owned());
}

/// Values that a host's progress callback has received, and the call at which it aborts.
struct Bar {
    shares: Vec<f64>,
    most: usize,
}

unsafe extern "C" fn on_progress(user: *mut c_void, share: f64) -> i32 {
    // SAFETY: `build` gave a live bar.
    let bar = unsafe { &mut *user.cast::<Bar>() };
    bar.shares.push(share);
    i32::from(bar.shares.len() >= bar.most)
}

/// Returns the path of a directory that cannot exist, because its parent is a file.
fn below_a_file() -> PathBuf {
    let file = std::env::temp_dir().join(format!("welkin-a-file-{}", std::process::id()));
    std::fs::write(&file, b"no directory").unwrap();
    file.join("no directory")
}

/// A device with one context on it that keeps its tables in a directory.
struct Simulator {
    device: *mut wk_device,
    context: *mut wk_context,
}

fn context_on(device: *mut wk_device, cache: &CStr) -> *mut wk_context {
    let mut context = null_mut();
    // The smallest tables, because the picture does not matter here.
    let sky = wk_sky_settings { model: WK_SKY_ISOTROPIC, suns: 16, altitudes: 8, ..init("wk_sky_settings") };
    let next = (&raw const sky).cast();
    let desc = wk_context_desc { next, cache_dir: cache.as_ptr(), ..init("wk_context_desc") };
    // SAFETY: live pointers.
    assert_eq!(unsafe { wk_context_create(device, &desc, &mut context) }, WK_OK, "{}", message());
    context
}

impl Simulator {
    fn new(cache: &Path) -> Self {
        let mut device = null_mut();
        let desc = init::<wk_device_desc>("wk_device_desc");
        // SAFETY: live pointers.
        assert_eq!(unsafe { wk_device_create(&desc, &mut device) }, WK_OK, "{}", message());
        let cache = CString::new(cache.to_str().expect("UTF-8")).expect("no NUL");
        Self { device, context: context_on(device, &cache) }
    }
}

impl Drop for Simulator {
    fn drop(&mut self) {
        // SAFETY: live handles.
        unsafe {
            assert_eq!(wk_context_destroy(self.context), WK_OK);
            assert_eq!(wk_device_destroy(self.device), WK_OK);
        }
    }
}

fn build(context: *mut wk_context, most: usize) -> (wk_status, Vec<f64>) {
    let mut bar = Bar { shares: Vec::new(), most };
    // SAFETY: the bar lives through the call.
    let status = unsafe { wk_context_build_sky(context, Some(on_progress), (&raw mut bar).cast()) };
    assert!(bar.shares.windows(2).all(|w| w[0] < w[1]) && bar.shares.iter().all(|s| (0.0..=1.0).contains(s)));
    (status, bar.shares)
}

/// Returns the number of tables that the first frame of a new view builds.
fn tables_of_a_first_frame(context: *mut wk_context) -> u32 {
    let mut view = null_mut();
    let mut report = init::<wk_report>("wk_report");
    let frame = init::<wk_frame>("wk_frame");
    // SAFETY: live pointers.
    unsafe {
        assert_eq!(wk_view_create(context, std::ptr::null(), &mut view), WK_OK, "{}", message());
        assert_eq!(wk_view_record(view, &frame, WK_STAGE_PREPARE), WK_OK, "{}", message());
        assert_eq!(wk_view_get_report(view, &mut report), WK_OK);
        assert_eq!(wk_view_destroy(view), WK_OK);
    }
    report.tables_rebuilt
}

fn directory(name: &str) -> PathBuf {
    std::env::temp_dir().join(format!("welkin-{name}-{}", std::process::id()))
}

fn files(directory: &Path) -> Vec<PathBuf> {
    std::fs::read_dir(directory).map_or_else(|_| Vec::new(), |d| d.map(|e| e.unwrap().path()).collect())
}

#[test]
fn tables_are_built_ahead_with_progress_and_come_back_from_a_file() {
    // SAFETY: a function and no user pointer.
    assert_eq!(unsafe { wk_set_log_callback(Some(on_log), null_mut(), WK_LOG_LEVEL_WARNING) }, WK_OK);
    let said = |text: &str| LOG.lock().unwrap().iter().any(|l| l.contains(text));
    let cache = directory("build-sky");
    {
        let host = Simulator::new(&cache);
        let (status, shares) = build(host.context, 3);
        assert_eq!((status, shares.len()), (WK_ERROR_ABORTED, 3));
        assert!(message().contains("aborted") && files(&cache).is_empty(), "{}", message());
        let (status, shares) = build(host.context, usize::MAX);
        assert_eq!((status, shares.last()), (WK_OK, Some(&1.0)), "{}", message());
        assert!(shares.len() >= 14 && files(&cache).len() == 1, "{shares:?}");
        // This context, or another one of the device, already shows the tables. Frames then draw only an observer's
        // tables.
        assert_eq!(build(host.context, usize::MAX), (WK_OK, vec![1.0]));
        let other = context_on(host.device, &CString::new(below_a_file().to_str().unwrap()).unwrap());
        assert_eq!(tables_of_a_first_frame(other), 1);
        // SAFETY: live handles; NULL is no callback.
        unsafe {
            assert_eq!(wk_context_build_sky(other, None, null_mut()), WK_OK, "{}", message());
            assert_eq!(wk_context_destroy(other), WK_OK);
        }
    }
    let host = Simulator::new(&cache);
    assert_eq!(tables_of_a_first_frame(host.context), 1, "a first frame reads the file too");
    drop(host);
    assert!(!said("damaged"));
    let file = files(&cache).remove(0);
    let whole = std::fs::read(&file).unwrap();
    std::fs::write(&file, &whole[..whole.len() / 2]).unwrap();
    let host = Simulator::new(&cache);
    let (status, shares) = build(host.context, usize::MAX);
    assert!(status == WK_OK && shares.len() >= 14 && said("damaged"), "{shares:?}");
    assert_eq!(std::fs::read(&file).unwrap(), whole, "mended, bit for bit");
    drop(host);
    std::fs::remove_dir_all(&cache).unwrap();
    // If the directory cannot exist, a warning is logged and the tables are built all the same.
    let host = Simulator::new(&below_a_file());
    assert_eq!(build(host.context, usize::MAX).0, WK_OK);
    assert!(said("not kept"));
    drop(host);
    std::fs::remove_file(below_a_file().parent().unwrap()).unwrap();
    // SAFETY: as above.
    assert_eq!(unsafe { wk_set_log_callback(None, null_mut(), WK_LOG_LEVEL_ERROR) }, WK_OK);
}

#[test]
fn a_directory_that_is_no_text_is_refused() {
    let mut device = null_mut();
    let mut context = null_mut();
    let desc = wk_device_desc { backends: WK_BACKEND_NOOP, ..init("wk_device_desc") };
    // SAFETY: live pointers.
    unsafe {
        assert_eq!(wk_device_create(&desc, &mut device), WK_OK);
        let desc = wk_context_desc { cache_dir: c"\xff".as_ptr(), ..init("wk_context_desc") };
        assert_eq!(wk_context_create(device, &desc, &mut context), WK_ERROR_INVALID_ARGUMENT);
        assert!(message().contains("desc.cache_dir must be UTF-8") && context.is_null(), "{}", message());
        assert_eq!(wk_device_destroy(device), WK_OK);
    }
}
