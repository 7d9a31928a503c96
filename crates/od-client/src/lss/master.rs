//! The LSS master: one service at a time.

use core::fmt;

use od_wire::lss::{MASTER, Request, Response, SLAVE};
use od_wire::{CanId, Duration, Frame, Instant, NodeId};

use super::fastscan::Fastscan;
use super::task::{Answer, Task};
use crate::error::Error;

/// Settings of the master.
///
/// ```
/// use od_client::Duration;
/// use od_client::lss::{Master, Options};
///
/// let mut options = Options::DEFAULT;
/// options.timeout = Duration::from_millis(500);
/// let master = Master::new(options);
/// assert!(!master.is_busy());
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub struct Options {
    /// Longest time from a request to its response. Storing takes longest.
    pub timeout: Duration,
    /// Time that a step of fastscan waits for a response. Finding a slave takes 65 to 133 steps; each bit
    /// that is 1 takes the whole time.
    pub scan: Duration,
    /// Time that a step of fastscan or identification waits after a response, because other slaves
    /// may send the same one. A late response would count for the next step.
    pub settle: Duration,
}

impl Options {
    /// 1 s for a response, 50 ms for a step of fastscan, 10 ms to settle.
    pub const DEFAULT: Self = Self {
        timeout: Duration::from_secs(1),
        scan: Duration::from_millis(50),
        settle: Duration::from_millis(10),
    };
}

impl Default for Options {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// The master still works on another service.
///
/// ```
/// use od_client::lss::{Busy, Master, Options, Task};
///
/// let mut master = Master::new(Options::DEFAULT);
/// assert_eq!(master.begin(Task::Fastscan), Ok(()));
/// assert_eq!(master.begin(Task::Store), Err(Busy));
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct Busy;

impl fmt::Display for Busy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the LSS master is at work on another service")
    }
}

impl core::error::Error for Busy {}

/// Service in progress.
#[derive(Clone, Copy, Debug)]
struct Work {
    task: Task,
    scan: Fastscan,
    /// The next frame; for a fastscan a placeholder 0.
    step: u8,
    /// End of the wait for a response.
    deadline: Option<Instant>,
    /// A slave has responded; the time for other slaves runs.
    heard: bool,
}

/// LSS master: takes one [`Task`] at a time, without queue and allocator.
///
/// ```
/// use od_client::lss::{Answer, Master, Options, Task};
/// use od_client::{Frame, Instant};
///
/// let mut master = Master::new(Options::DEFAULT);
/// master.begin(Task::InquireNodeId).expect("nothing is under way");
/// let request = master.poll_transmit(Instant::ZERO).expect("a request");
/// assert_eq!(request.to_string(), "7E5#5E00000000000000");
/// master.handle_frame(Instant::ZERO, &Frame::standard(0x7E4, &[0x5E, 0xFF, 0, 0, 0, 0, 0, 0]));
/// assert_eq!(master.poll_answer(), Some(Ok(Answer::NodeId(None))));
/// ```
#[derive(Clone, Debug)]
pub struct Master {
    options: Options,
    work: Option<Work>,
    answer: Option<Result<Answer, Error>>,
}

impl Master {
    /// A master without a service in progress.
    pub const fn new(options: Options) -> Self {
        Self {
            options,
            work: None,
            answer: None,
        }
    }

    /// Begins a service. A result that was not taken is dropped.
    ///
    /// # Errors
    /// [`Busy`] while another service is in progress.
    pub fn begin(&mut self, task: Task) -> Result<(), Busy> {
        if self.work.is_some() {
            return Err(Busy);
        }
        self.answer = None;
        self.work = Some(Work {
            task,
            scan: Fastscan::new(),
            step: 0,
            deadline: None,
            heard: false,
        });
        Ok(())
    }

    /// Returns whether a service is in progress.
    pub const fn is_busy(&self) -> bool {
        self.work.is_some()
    }

    /// Ends the service in progress, without a result.
    pub fn cancel(&mut self) {
        self.work = None;
    }

    /// Handles a frame from the bus. Frames other than responses of LSS slaves to the service are ignored.
    pub fn handle_frame(&mut self, now: Instant, frame: &Frame) {
        let Some(work) = &mut self.work else { return };
        if frame.id() != CanId::standard(SLAVE) || work.deadline.is_none() {
            return;
        }
        let Some(response) = Response::parse(frame.data()) else {
            return;
        };
        let answer = match (work.task, response) {
            (Task::Fastscan | Task::Identify { .. }, Response::Identified)
            | (Task::IdentifyNonConfigured, Response::NonConfigured) => {
                if !work.heard {
                    work.heard = true;
                    work.deadline = Some(now + self.options.settle);
                }
                return;
            }
            (Task::SwitchSelective(_), Response::Selected { .. }) => Ok(Answer::Done),
            (Task::Inquire(asked), Response::Number { part, value }) if part == asked => {
                Ok(Answer::Number(value))
            }
            (Task::InquireNodeId, Response::NodeId { node_id }) => {
                match (node_id, NodeId::new(node_id)) {
                    // 255 is that of a slave without a node ID; some send 0.
                    (0 | 0xFF, _) => Ok(Answer::NodeId(None)),
                    (_, Some(node)) => Ok(Answer::NodeId(Some(node))),
                    (other, None) => Err(Error::InvalidNodeId(other)),
                }
            }
            (task, Response::Configured { command, error }) if is_command(task, command) => {
                match error {
                    0 => Ok(Answer::Done),
                    error => Err(Error::Refused {
                        error,
                        specific: frame.bytes()[2],
                    }),
                }
            }
            _ => return,
        };
        self.end(answer);
    }

    /// Continues or gives up if the time of a step is over; does nothing before
    /// [`poll_timeout`](Self::poll_timeout).
    pub fn handle_timeout(&mut self, now: Instant) {
        let Some(work) = &mut self.work else { return };
        if work.deadline.is_none_or(|at| at > now) {
            return;
        }
        work.deadline = None;
        let heard = core::mem::take(&mut work.heard);
        let answer = match work.task {
            Task::Fastscan => {
                work.step = 0;
                work.scan.step(heard)
            }
            task if task.is_question() => Some(Ok(Answer::Exists(heard))),
            _ => Some(Err(Error::Silent)),
        };
        if let Some(answer) = answer {
            self.end(answer);
        }
    }

    /// Returns the next frame to send; the time for the response starts at `now`.
    pub fn poll_transmit(&mut self, now: Instant) -> Option<Frame> {
        let work = self.work.as_mut()?;
        let (request, wait) = match work.task {
            Task::Fastscan if work.step == 0 => (work.scan.request(), self.options.scan),
            task => (task.request(work.step)?, self.options.timeout),
        };
        work.step += 1;
        let is_last = work.task.request(work.step).is_none();
        if is_last && work.task.is_unconfirmed() {
            self.end(Ok(Answer::Done));
        } else if is_last {
            work.deadline = Some(now + wait);
        }
        Some(Frame::full(CanId::standard(MASTER), request.emit()))
    }

    /// Returns when to call [`handle_timeout`](Self::handle_timeout), if at all.
    pub fn poll_timeout(&self) -> Option<Instant> {
        self.work.as_ref()?.deadline
    }

    /// Returns the result of the service, once.
    pub fn poll_answer(&mut self) -> Option<Result<Answer, Error>> {
        self.answer.take()
    }

    fn end(&mut self, answer: Result<Answer, Error>) {
        self.work = None;
        self.answer = Some(answer);
    }
}

/// Returns whether the request of a task has this command, which a slave repeats in its confirmation.
fn is_command(task: Task, command: u8) -> bool {
    let request = task.request(0).map(Request::emit);
    request.is_some_and(|[own, ..]| own == command)
}
