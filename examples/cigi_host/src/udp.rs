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

/// Longest wait in lock-step.
const PATIENCE: Duration = Duration::from_secs(1);
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
        let mut done = 0;
        while frames.is_none_or(|frames| done < frames) {
            done += 1;
            let deadline = match pace {
                Pace::Rate(hertz) => began + Duration::from_secs_f64(done as f64 / hertz),
                Pace::LockStep => Instant::now() + PATIENCE,
            };
            while let Some(from) = self.message_before(deadline, &mut buffer)? {
                answers_go = Some(self.host.unwrap_or(from));
                if pace == Pace::LockStep {
                    break;
                }
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

    /// Returns who sent the next good message, or `None` once the deadline is over.
    fn message_before(&mut self, deadline: Instant, buffer: &mut [u8]) -> io::Result<Option<SocketAddr>> {
        loop {
            let left = deadline.saturating_duration_since(Instant::now());
            if left.is_zero() {
                return Ok(None);
            }
            self.socket.set_read_timeout(Some(left.max(SHORTEST)))?;
            match self.socket.recv_from(buffer) {
                Ok((_, from)) if self.host.is_some_and(|host| host.ip() != from.ip()) => {}
                Ok((length, from)) => {
                    if self.session.receive(&buffer[..length]).is_ok() {
                        return Ok(Some(from));
                    }
                }
                Err(e) if matches!(e.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => return Ok(None),
                Err(e) if matches!(e.kind(), ErrorKind::Interrupted | ErrorKind::ConnectionReset) => {}
                Err(e) => return Err(e),
            }
        }
    }
}
