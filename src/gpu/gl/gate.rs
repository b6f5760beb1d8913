//! Lock that lets one thread at a time use an OpenGL context. A context can be current on one thread only, and no other
//! thread's calls may come between those of a batch.

use std::{
    sync::{Condvar, Mutex, MutexGuard, PoisonError},
    thread::{self, ThreadId},
};

/// Reentrant lock. A call to [`Gate::leave`] releases the lock, not the drop of a guard, because entering and leaving a
/// host are two calls.
#[derive(Default)]
pub(super) struct Gate {
    /// Thread that holds the lock, and its depth: the number of its enters that are not undone yet.
    state: Mutex<(Option<ThreadId>, u32)>,
    /// Signalled when the lock is released.
    freed: Condvar,
}

impl Gate {
    /// Waits until no other thread holds the lock. Returns this thread's depth, which is 1 after its first enter.
    pub(super) fn enter(&self) -> u32 {
        let me = Some(thread::current().id());
        let mut state = self.lock();
        while state.0.is_some() && state.0 != me {
            state = self.freed.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
        *state = (me, state.1 + 1);
        state.1
    }

    /// Returns this thread's depth: 0 if it does not hold the lock.
    pub(super) fn depth(&self) -> u32 {
        let state = self.lock();
        if state.0 == Some(thread::current().id()) { state.1 } else { 0 }
    }

    /// Undoes one [`Gate::enter`] of this thread.
    pub(super) fn leave(&self) {
        let mut state = self.lock();
        state.1 = state.1.saturating_sub(1);
        if state.1 == 0 {
            state.0 = None;
            drop(state);
            self.freed.notify_one();
        }
    }

    fn lock(&self) -> MutexGuard<'_, (Option<ThreadId>, u32)> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;

    #[test]
    fn the_owner_enters_again_and_others_wait() {
        let gate = Arc::new(Gate::default());
        assert_eq!((gate.enter(), gate.enter(), gate.depth()), (1, 2, 2));
        let other = gate.clone();
        let (sent, received) = std::sync::mpsc::channel();
        let thread = thread::spawn(move || {
            assert_eq!(other.depth(), 0);
            assert_eq!(other.enter(), 1);
            sent.send(()).unwrap();
            other.leave();
        });
        gate.leave();
        assert!(
            received.recv_timeout(std::time::Duration::from_millis(50)).is_err(),
            "entered while another is inside"
        );
        gate.leave();
        received.recv_timeout(std::time::Duration::from_secs(5)).unwrap();
        thread.join().unwrap();
    }
}
