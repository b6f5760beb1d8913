//! Order on the queue: semaphores in both directions, and one queue that host and Welkin use at the same time under a
//! lock.

use std::ffi::c_void;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::Duration;

use ash::vk;
use welkin::gpu::vulkan::{HandOver, HostSemaphore, adopt};

use crate::host::{Host, Setup};
use crate::{Picture, adopted, assert_all};

const LAYOUTS: [vk::ImageLayout; 2] =
    [vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL, vk::ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL];

#[test]
fn binary_semaphores_order_both_ways() {
    let host = Host::new(Setup::modern());
    let welkin = adopted(&host);
    let picture = Picture::new(&host, vk::Format::D32_SFLOAT);
    let (drawn, weather) = (host.semaphore(false), host.semaphore(false));
    for _ in 0..5 {
        picture.clear(&host, 0.25, LAYOUTS, &[drawn]);
        let wait = [HostSemaphore { semaphore: drawn, value: None }];
        let signal = [HostSemaphore { semaphore: weather, value: None }];
        picture.draw(&welkin, LAYOUTS, &HandOver { wait: &wait, signal: &signal, ..Default::default() });
        assert_all(&host.read(&picture.colour.image, &[weather]), [64, 255, 128, 255]);
    }
    welkin.close().unwrap();
    host.destroy_semaphore(drawn);
    host.destroy_semaphore(weather);
    picture.destroy(&host);
    host.finish();
}

#[test]
fn timeline_values_are_waited_for_and_signalled() {
    let host = Host::new(Setup::modern());
    let welkin = adopted(&host);
    let picture = Picture::new(&host, vk::Format::D32_SFLOAT);
    let (drawn, weather) = (host.semaphore(true), host.semaphore(true));
    // SAFETY: plain Vulkan by its rules, here and below.
    let value = |s| unsafe { host.device.get_semaphore_counter_value(s).unwrap() };
    for frame in 1..=3_u64 {
        picture.clear(&host, 0.75, LAYOUTS, &[]);
        let wait = [HostSemaphore { semaphore: drawn, value: Some(frame) }];
        let signal = [HostSemaphore { semaphore: weather, value: Some(10 * frame) }];
        picture.draw(&welkin, LAYOUTS, &HandOver { wait: &wait, signal: &signal, ..Default::default() });
        std::thread::sleep(Duration::from_millis(50));
        assert_eq!(value(weather), 10 * (frame - 1), "it must wait for the host's value");
        let info = vk::SemaphoreSignalInfo::default().semaphore(drawn).value(frame);
        unsafe { host.device.signal_semaphore(&info).unwrap() };
        let (semaphores, values) = ([weather], [10 * frame]);
        let info = vk::SemaphoreWaitInfo::default().semaphores(&semaphores).values(&values);
        unsafe { host.device.wait_semaphores(&info, 5_000_000_000).expect("the value is signalled") };
        assert_all(&host.read(&picture.colour.image, &[]), [191, 255, 128, 255]);
    }
    host.assert_valid();
    welkin.close().unwrap();
    host.destroy_semaphore(drawn);
    host.destroy_semaphore(weather);
    picture.destroy(&host);
    host.finish();
}

/// A host's mutex as the callbacks see it.
#[derive(Default)]
struct QueueMutex {
    held: AtomicU32,
    taken: AtomicU32,
    broken: AtomicU32,
    gate: Mutex<bool>,
    opened: std::sync::Condvar,
}

impl QueueMutex {
    fn lock(&self) {
        let mut busy = self.gate.lock().unwrap();
        while *busy {
            busy = self.opened.wait(busy).unwrap();
        }
        *busy = true;
        if self.held.fetch_add(1, Ordering::SeqCst) != 0 {
            self.broken.fetch_add(1, Ordering::SeqCst);
        }
        self.taken.fetch_add(1, Ordering::SeqCst);
    }

    fn unlock(&self) {
        if self.held.fetch_sub(1, Ordering::SeqCst) != 1 {
            self.broken.fetch_add(1, Ordering::SeqCst);
        }
        *self.gate.lock().unwrap() = false;
        self.opened.notify_one();
    }
}

unsafe extern "C" fn lock(user: *mut c_void) {
    // SAFETY: `user` is the test's QueueMutex, which outlives the device.
    unsafe { (*user.cast::<QueueMutex>()).lock() }
}

unsafe extern "C" fn unlock(user: *mut c_void) {
    // SAFETY: as above.
    unsafe { (*user.cast::<QueueMutex>()).unlock() }
}

#[test]
fn host_and_welkin_share_the_queue_under_the_hosts_lock() {
    let host = Host::new(Setup::modern());
    let mutex = QueueMutex::default();
    let mut desc = host.desc();
    desc.lock_queue = Some(lock);
    desc.unlock_queue = Some(unlock);
    desc.user = (&raw const mutex).cast_mut().cast();
    // SAFETY: the description is true; mutex and host outlive the device.
    let welkin = unsafe { adopt(&desc).unwrap() };
    let picture = Picture::new(&host, vk::Format::D32_SFLOAT);
    picture.clear(&host, 0.25, LAYOUTS, &[]);
    picture.draw(&welkin, LAYOUTS, &HandOver::default());
    let before = mutex.taken.load(Ordering::SeqCst);
    assert!(before > 0, "the lock was never taken");
    let back = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
    std::thread::scope(|s| {
        s.spawn(|| {
            for _ in 0..100 {
                mutex.lock();
                // SAFETY: the queue is held by the mutex.
                unsafe { host.device.queue_submit(host.queue, &[], vk::Fence::null()).unwrap() };
                mutex.unlock();
            }
        });
        for _ in 0..30 {
            picture.draw(&welkin, [back, LAYOUTS[1]], &HandOver::default());
        }
    });
    assert!(mutex.taken.load(Ordering::SeqCst) >= before + 130);
    assert_eq!(mutex.broken.load(Ordering::SeqCst), 0, "lock and unlock must pair up");
    assert_all(&host.read(&picture.colour.image, &[]), [64, 255, 128, 255]);
    welkin.close().unwrap();
    assert_eq!(mutex.held.load(Ordering::SeqCst), 0);
    picture.destroy(&host);
    host.finish();
}

#[test]
fn refused_commands_leave_no_semaphore_staged() {
    let host = Host::new(Setup::modern());
    let welkin = adopted(&host);
    let picture = Picture::new(&host, vk::Format::D32_SFLOAT);
    let weather = host.semaphore(true);
    let signal = [HostSemaphore { semaphore: weather, value: Some(1) }];
    let encoder = welkin.device.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let buffer = welkin.device.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: 16,
        usage: wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let mut encoder = encoder;
    encoder.clear_buffer(&buffer, 0, None);
    buffer.destroy();
    drop(buffer);
    let over = HandOver { signal: &signal, ..Default::default() };
    // SAFETY: the semaphore is live and a timeline one.
    let e = unsafe { welkin.submit(encoder, &over) }.unwrap_err();
    assert_eq!(e.status, welkin::Status::Internal, "{e}");
    picture.clear(&host, 0.25, LAYOUTS, &[]);
    picture.draw(&welkin, LAYOUTS, &HandOver::default());
    host.read(&picture.colour.image, &[]);
    // SAFETY: plain Vulkan by its rules.
    assert_eq!(unsafe { host.device.get_semaphore_counter_value(weather).unwrap() }, 0);
    welkin.close().unwrap();
    host.destroy_semaphore(weather);
    picture.destroy(&host);
    host.finish();
}
