//! Runs the lines of the control socket on a live bench.

use super::control::Turn;
use super::links::opened::Protocol;
use super::live::Live;
use super::stats::Guest;
use super::terminal::note;

/// Lines that run before other clients have their turn.
const TURN: usize = 256;

impl Live {
    /// A line of a client of the control socket.
    pub(super) fn command(&mut self, number: usize, text: &str) {
        self.catch_up();
        if !self.control.push(number, text) {
            note("a control client was disconnected: it sent too many lines at once");
            self.control.leave(number);
            self.clients.remove(number);
        }
        self.run_control();
    }

    /// Runs the lines that are due, and answers them.
    pub(super) fn run_control(&mut self) {
        for _ in 0..TURN {
            let Some(turn) = self.control.step(&mut self.bench) else {
                return;
            };
            match turn {
                Turn::Frame(client, frame) => {
                    if !self.frame(&frame, None) {
                        self.control.refused(client, frame);
                    }
                }
                Turn::Changed => self.deliver(),
                Turn::Answer(number, text) => {
                    self.clients.answer(number, format!("{text}\n").as_bytes());
                }
                Turn::Stats(number, json) => {
                    let figures = self.figures(json);
                    self.clients.answer(number, figures.as_bytes());
                }
            }
        }
    }

    /// The figures, as the answer to a line.
    fn figures(&mut self, json: bool) -> String {
        let (bus, stats) = (&self.bench.bus, &mut self.stats);
        let clients = self.clients.all();
        let clients = clients.filter(|client| client.protocol != Protocol::Control);
        let guests: Vec<Guest<'_>> = clients
            .map(|client| Guest {
                number: client.number,
                name: &client.name,
                protocol: client.protocol.name(),
                dropped: client.lost,
                missed: client.port.missed(),
            })
            .collect();
        if json {
            return format!("ok {}\n", stats.json(bus, &guests));
        }
        let text = stats.text(bus, &guests);
        let lines: String = text.lines().map(|line| format!("| {line}\n")).collect();
        lines + "ok\n"
    }
}
