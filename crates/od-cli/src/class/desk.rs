//! The requests of a class: files of the page, reports of students, and what the trainer does.

use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use serde::Deserialize;
use serde_json::json;

use super::http::{Answer, Request};
use super::room::{Report, Room};
use super::site::Site;
use crate::failure::Failure;

/// A class with its page.
pub(super) struct Desk {
    pub(super) site: Site,
    pub(super) room: Mutex<Room>,
    /// Allows the trainer's requests.
    pub(super) token: String,
    /// The address for the students.
    pub(super) address: String,
    /// Makes a random word.
    pub(super) random: fn() -> Result<String, Failure>,
}

#[derive(Deserialize)]
struct Join {
    name: String,
    /// The key of a page that joined before.
    key: Option<String>,
}

#[derive(Deserialize)]
struct Offered {
    lesson: String,
    /// The student; without it, all.
    row: Option<u32>,
}

#[derive(Deserialize)]
struct Removed {
    row: u32,
}

impl Desk {
    pub(super) fn answer(&self, request: &Request, now: Instant) -> Answer {
        let answered = request
            .admitted()
            .and_then(|()| match request.method.as_str() {
                "GET" | "HEAD" => self.get(request, now),
                "POST" => self.post(request, now),
                _ => Err(Answer::text(405, "GET, HEAD or POST")),
            });
        answered.unwrap_or_else(|refused| refused)
    }

    fn get(&self, request: &Request, now: Instant) -> Result<Answer, Answer> {
        if request.path != "/class/rows" {
            let known = request.known.as_deref();
            return Ok(self.site.answer(&request.path, request.has_query, known));
        }
        self.trainer(request)?;
        let room = self.room();
        let rows = json!({ "address": self.address, "rows": room.rows(now) });
        Ok(Answer::json(200, &rows))
    }

    fn post(&self, request: &Request, now: Instant) -> Result<Answer, Answer> {
        let mut room = self.room();
        let found = match request.path.as_str() {
            "/class/join" => {
                let Join { name, key } = read(request)?;
                return Ok(match room.join(&name, key.as_deref(), self.word()?, now) {
                    Ok(joined) => Answer::json(200, &joined),
                    Err(why) => Answer::json(409, &json!({ "why": why })),
                });
            }
            "/class/report" => {
                let report: Report = read(request)?;
                return Ok(match room.report(report, now) {
                    Ok(offer) => Answer::json(200, &json!({ "offer": offer })),
                    Err(why) => Answer::json(410, &json!({ "why": why })),
                });
            }
            "/class/offer" => {
                self.trainer(request)?;
                let Offered { lesson, row } = read(request)?;
                room.offer(&lesson, row)
            }
            "/class/remove" => {
                self.trainer(request)?;
                let Removed { row } = read(request)?;
                room.remove(row)
            }
            "/class/reset" => {
                self.trainer(request)?;
                room.reset(self.word()?);
                true
            }
            _ => return Err(Answer::text(404, "not found")),
        };
        // The row may have been removed in another window of the trainer.
        Ok(Answer::json(200, &json!({ "found": found })))
    }

    /// The students.
    pub(super) fn room(&self) -> MutexGuard<'_, Room> {
        self.room.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn word(&self) -> Result<String, Answer> {
        (self.random)().map_err(|failure| Answer::text(500, &failure.to_string()))
    }

    /// Checks the token of the trainer.
    fn trainer(&self, request: &Request) -> Result<(), Answer> {
        match &request.token {
            Some(token) if *token == self.token => Ok(()),
            _ => Err(Answer::text(
                403,
                "use the trainer's address that odkit printed",
            )),
        }
    }
}

fn read<T: for<'d> Deserialize<'d>>(request: &Request) -> Result<T, Answer> {
    let wrong = |error: serde_json::Error| Answer::text(400, &format!("the request: {error}"));
    serde_json::from_slice(&request.body).map_err(wrong)
}
