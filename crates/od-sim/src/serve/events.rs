//! The one place where the bench waits: for sockets, for a time, for another thread.

use std::io;
use std::sync::Arc;
use std::time::Duration;

use mio::{Poll, Registry, Token, Waker};

/// Token of [`Events::waker`].
const WAKE: Token = Token(usize::MAX);
#[cfg(target_os = "linux")]
const TIMER: Token = Token(usize::MAX - 1);

/// Directions in which a link is ready again.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Ready {
    /// `None`: another thread woke the loop; any port may be ready.
    pub(super) number: Option<usize>,
    pub(super) readable: bool,
    pub(super) writable: bool,
}

/// The events of all ports.
pub(super) struct Events {
    poll: Poll,
    ready: mio::Events,
    waker: Arc<Waker>,
    /// The timeouts of `epoll` are whole milliseconds.
    #[cfg(target_os = "linux")]
    timer: nix::sys::timerfd::TimerFd,
}

impl Events {
    pub(super) fn new() -> io::Result<Self> {
        let poll = Poll::new()?;
        let waker = Arc::new(Waker::new(poll.registry(), WAKE)?);
        Ok(Self {
            #[cfg(target_os = "linux")]
            timer: timer(poll.registry())?,
            poll,
            ready: mio::Events::with_capacity(1024),
            waker,
        })
    }

    pub(super) fn registry(&self) -> &Registry {
        self.poll.registry()
    }

    /// Ends a [`wait`](Self::wait), from any thread.
    pub(super) fn waker(&self) -> &Arc<Waker> {
        &self.waker
    }

    /// Waits for events, at most as long as `patience`.
    pub(super) fn wait(&mut self, patience: Duration) -> io::Result<impl Iterator<Item = Ready>> {
        let patience = self.arm(patience)?;
        match self.poll.poll(&mut self.ready, patience) {
            Err(error) if error.kind() == io::ErrorKind::Interrupted => self.ready.clear(),
            done => done?,
        }
        Ok(self.ready.iter().map(|event| Ready {
            number: (event.token() != WAKE).then_some(event.token().0),
            readable: event.is_readable() || event.is_read_closed() || event.is_error(),
            writable: event.is_writable() || event.is_write_closed() || event.is_error(),
        }))
    }

    /// Sets the timer, and returns the timeout that is left for `poll`.
    #[cfg(target_os = "linux")]
    fn arm(&self, patience: Duration) -> io::Result<Option<Duration>> {
        use nix::sys::time::TimeSpec;
        use nix::sys::timerfd::{Expiration, TimerSetTimeFlags};

        if patience.is_zero() {
            return Ok(Some(patience));
        }
        let when = Expiration::OneShot(TimeSpec::from_duration(patience));
        self.timer.set(when, TimerSetTimeFlags::empty())?;
        Ok(None)
    }

    #[cfg(not(target_os = "linux"))]
    fn arm(&self, patience: Duration) -> io::Result<Option<Duration>> {
        Ok(Some(patience))
    }
}

#[cfg(target_os = "linux")]
fn timer(registry: &Registry) -> io::Result<nix::sys::timerfd::TimerFd> {
    use std::os::fd::{AsFd, AsRawFd};

    use mio::Interest;
    use mio::unix::SourceFd;
    use nix::sys::timerfd::{ClockId, TimerFd, TimerFlags};

    let flags = TimerFlags::TFD_NONBLOCK | TimerFlags::TFD_CLOEXEC;
    let timer = TimerFd::new(ClockId::CLOCK_MONOTONIC, flags)?;
    let number = timer.as_fd().as_raw_fd();
    registry.register(&mut SourceFd(&number), TIMER, Interest::READABLE)?;
    Ok(timer)
}

#[cfg(test)]
mod tests {
    use std::time::Instant;

    use super::*;

    #[test]
    fn a_wait_ends_at_its_moment_or_when_it_is_called() {
        let mut events = Events::new().expect("events");
        let start = Instant::now();
        let patience = Duration::from_micros(1500);
        let ready: Vec<_> = events.wait(patience).expect("a wait").collect();
        assert!(ready.iter().all(|ready| ready.number.is_some()));
        assert!(start.elapsed() >= patience);
        let waker = Arc::clone(events.waker());
        let other = std::thread::spawn(move || waker.wake());
        let mut ready = events.wait(Duration::from_secs(3600)).expect("a wait");
        assert_eq!(ready.next().map(|ready| ready.number), Some(None));
        drop(ready);
        other.join().expect("no panic").expect("it wakes");
    }
}
