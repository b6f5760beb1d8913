//! A session over UDP: takes what arrives, and sends one message a frame.

use std::io::{self, ErrorKind};
use std::net::{SocketAddr, UdpSocket};
use std::time::{Duration, Instant};

use crate::session::Session;
use crate::world::World;

/// When a frame begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pace {
    /// So often a second; all that has arrived by then counts.
    Rate(f64),
    /// With each good message from the host; and once a second without one, so that a host that waits can begin.
    LockStep,
}

/// Longest wait in lock-step, and at a rate that is no number above 0.
const PATIENCE: Duration = Duration::from_secs(1);
/// Most datagrams of one frame: a flood does not keep a frame from its time.
const MAX_DATAGRAMS: usize = 1024;
/// Shortest time limit that a socket takes.
const SHORTEST: Duration = Duration::from_micros(10);

/// A session with its socket.
pub struct Link<'a> {
    /// Socket that the host sends to.
    pub socket: UdpSocket,
    /// Address of the host; `None` for that of its last good message.
    pub host: Option<SocketAddr>,
    /// The session.
    pub session: Session,
    /// The world that answers.
    pub world: &'a mut dyn World,
}

impl Link<'_> {
    /// Runs frames until `frames` are done, or for ever. Calls `after` behind each frame.
    ///
    /// # Errors
    /// The socket's, but for those that pass.
    pub fn run(&mut self, pace: Pace, frames: Option<u64>, mut after: impl FnMut(&Session)) -> io::Result<()> {
        let began = Instant::now();
        let mut buffer = vec![0; 65_536];
        let mut answers_go = self.host;
        let (mut done, mut last) = (0, began);
        while frames.is_none_or(|frames| done < frames) {
            done += 1;
            let period = match pace {
                Pace::Rate(hertz) => Duration::try_from_secs_f64(1.0 / hertz).unwrap_or(PATIENCE),
                Pace::LockStep => PATIENCE,
            };
            // Frames that a stall has left out are not made up for.
            last = Instant::now().max(last + period);
            if let Some(from) = self.take_before(last, pace, &mut buffer)? {
                answers_go = Some(self.host.unwrap_or(from));
            }
            let ticks = began.elapsed().as_micros() / 10;
            let message = self.session.frame(ticks as u32, self.world);
            if let Some(address) = answers_go {
                // A host that is gone for a while is no reason to end.
                let _ = self.socket.send_to(message, address);
            }
            after(&self.session);
        }
        Ok(())
    }

    /// Takes what arrives before the deadline, in lock-step one good message, and returns who sent the last good one.
    /// What lies in the socket already counts after the deadline too.
    fn take_before(&mut self, deadline: Instant, pace: Pace, buffer: &mut [u8]) -> io::Result<Option<SocketAddr>> {
        let mut good = None;
        for _ in 0..MAX_DATAGRAMS {
            let left = deadline.saturating_duration_since(Instant::now());
            self.socket.set_read_timeout(Some(left.max(SHORTEST)))?;
            match self.socket.recv_from(buffer) {
                Ok((_, from)) if self.host.is_some_and(|host| host.ip() != from.ip()) => {}
                Ok((length, from)) => {
                    if self.session.receive(&buffer[..length]).is_ok() {
                        good = Some(from);
                        if pace == Pace::LockStep {
                            return Ok(good);
                        }
                    }
                }
                Err(e) if matches!(e.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => return Ok(good),
                Err(e) if matches!(e.kind(), ErrorKind::Interrupted | ErrorKind::ConnectionReset) => {}
                Err(e) => return Err(e),
            }
        }
        std::thread::sleep(deadline.saturating_duration_since(Instant::now()));
        Ok(good)
    }
}
