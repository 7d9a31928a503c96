//! The students of a class and what each of them does. Time is an argument.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};

/// Maximum number of students.
const MOST: usize = 40;
/// Maximum length of a student's name, in characters.
const NAME: usize = 40;
/// Maximum length of the name of a lesson, in bytes.
const LESSON: usize = 120;
/// Maximum number of lessons that a page reports as done.
const LESSONS: usize = 200;
/// Maximum number of steps of a lesson: the page of the trainer draws each of them.
const STEPS: u32 = 200;
/// A page reports every two seconds. After this time without a report, its connection is lost.
const LOST: Duration = Duration::from_secs(8);
/// As [`LOST`], for a page in a hidden tab: browsers slow its timers down to one call a minute.
const LOST_HIDDEN: Duration = Duration::from_secs(90);
/// Number of wrong answers in a step after which a student is stuck.
const WRONG: u32 = 3;
/// Maximum number of former groups and removed rows that are remembered.
const FORMER: usize = 200;

/// The place of a student in a lesson.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub(super) struct At {
    /// Name of the lesson.
    name: String,
    /// Number of steps that are done.
    step: u32,
    /// Number of all steps.
    of: u32,
    /// Wrong answers to the question of this step.
    wrong: u32,
    /// Hints of this step that were opened.
    hints: u32,
    /// Steps of the lesson that the page did for the student.
    shown: u32,
}

impl At {
    /// Returns whether the page of the trainer can show the place.
    fn is_valid(&self) -> bool {
        is_name(&self.name) && self.step <= self.of && self.of <= STEPS
    }
}

/// Returns whether a text can be the name of a lesson.
fn is_name(text: &str) -> bool {
    text.len() <= LESSON && od_model::Visible(text).line() == text
}

/// A report of a page.
#[derive(Clone, Debug, Deserialize)]
pub(super) struct Report {
    key: String,
    group: String,
    /// The page is in a tab that is not visible.
    hidden: bool,
    lesson: Option<At>,
    /// Names of the lessons that are done.
    finished: Vec<String>,
    /// Number of the last offer that the student accepted or dismissed.
    answered: u32,
}

/// A lesson that the trainer offers.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub(super) struct Offer {
    /// Counts the offers of the trainer.
    number: u32,
    lesson: String,
}

/// Result of joining, for a page.
#[derive(Debug, PartialEq, Eq, Serialize)]
pub(super) struct Joined {
    key: String,
    group: String,
    name: String,
}

/// Reason why a page cannot join.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Refused {
    /// The name is empty, too long, or has characters that are not visible.
    Name,
    /// A connected student has this name.
    Taken,
    /// The class has [`MOST`] students.
    Full,
}

/// Reason why the key of a page is not valid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Gone {
    /// The trainer has reset the class for the next group.
    Reset,
    /// The trainer has removed this row.
    Removed,
    /// The program was started again: the page can join again.
    Unknown,
}

/// Connection of a page.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Presence {
    Here,
    /// Another tab or program covers the page.
    Hidden,
    Lost,
}

/// Reason why a student counts as stuck.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Stuck {
    /// No progress for the time of the class.
    Time,
    /// Several wrong answers to the question of the step.
    Wrong,
}

struct Row {
    id: u32,
    key: String,
    name: String,
    /// Time of the last report.
    heard: Instant,
    is_hidden: bool,
    at: Option<At>,
    /// Time at which the step began.
    since: Instant,
    finished: Vec<String>,
    offer: Option<Offer>,
    answered: u32,
}

/// A row of the trainer's table. Times are in seconds.
#[derive(Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Shown<'r> {
    id: u32,
    name: &'r str,
    presence: Presence,
    /// Time since the last report.
    silent: u64,
    at: Option<&'r At>,
    /// Time since the step began.
    idle: u64,
    stuck: Option<Stuck>,
    finished: &'r [String],
    /// Name of the offered lesson that the student neither accepted nor dismissed.
    offer: Option<&'r str>,
}

impl Row {
    fn presence(&self, now: Instant) -> Presence {
        let silent = now.saturating_duration_since(self.heard);
        match self.is_hidden {
            true if silent < LOST_HIDDEN => Presence::Hidden,
            false if silent < LOST => Presence::Here,
            _ => Presence::Lost,
        }
    }

    fn stuck(&self, now: Instant, patience: Duration) -> Option<Stuck> {
        let at = self.at.as_ref().filter(|at| at.step < at.of)?;
        if self.presence(now) == Presence::Lost {
            return None;
        }
        if at.wrong >= WRONG {
            return Some(Stuck::Wrong);
        }
        let is_long = now.saturating_duration_since(self.since) >= patience;
        is_long.then_some(Stuck::Time)
    }

    /// The offer that waits for an answer.
    fn offer(&self) -> Option<&Offer> {
        self.offer
            .as_ref()
            .filter(|offer| offer.number > self.answered)
    }
}

/// The students of one group after the other.
pub(super) struct Room {
    /// Time without progress after which a student is stuck.
    patience: Duration,
    group: String,
    rows: Vec<Row>,
    /// Number of the next row.
    next: u32,
    /// Number of the last offer.
    offers: u32,
    /// The last offer to all: a student who joins later gets it, too.
    for_all: Option<Offer>,
    former: VecDeque<String>,
    removed: VecDeque<String>,
}

impl Room {
    /// An empty class. `group` is a random name for its first group.
    pub(super) fn new(group: String, patience: Duration) -> Self {
        Self {
            patience,
            group,
            rows: Vec::new(),
            next: 1,
            offers: 0,
            for_all: None,
            former: VecDeque::new(),
            removed: VecDeque::new(),
        }
    }

    /// Adds a student, or gives back the row of a student of this name whose connection is lost. The row of the page with
    /// the key `former` gets another name. `key` is a random word that the page reports with.
    pub(super) fn join(
        &mut self,
        name: &str,
        former: Option<&str>,
        key: String,
        now: Instant,
    ) -> Result<Joined, Refused> {
        let name = name.split_whitespace().collect::<Vec<_>>().join(" ");
        let is_visible = od_model::Visible(&name).lines() == name;
        if name.is_empty() || name.chars().count() > NAME || !is_visible {
            return Err(Refused::Name);
        }
        let is_same = |row: &Row| row.name.to_lowercase() == name.to_lowercase();
        let own = self.rows.iter().position(|row| former == Some(&row.key));
        let same = self.rows.iter().position(is_same);
        if let Some(place) = same.or(own) {
            if Some(place) != own && self.rows[place].presence(now) != Presence::Lost {
                return Err(Refused::Taken);
            }
            let row = &mut self.rows[place];
            row.name.clone_from(&name);
            row.key.clone_from(&key);
            row.heard = now;
            if let Some(own) = own.filter(|own| *own != place) {
                self.rows.remove(own);
            }
        } else if self.rows.len() >= MOST {
            return Err(Refused::Full);
        } else {
            self.rows.push(Row {
                id: self.next,
                key: key.clone(),
                name: name.clone(),
                heard: now,
                is_hidden: false,
                at: None,
                since: now,
                finished: Vec::new(),
                offer: self.for_all.clone(),
                answered: 0,
            });
            self.next += 1;
        }
        let group = self.group.clone();
        Ok(Joined { key, group, name })
    }

    /// Takes a report, and returns the offer that waits for an answer.
    pub(super) fn report(&mut self, report: Report, now: Instant) -> Result<Option<Offer>, Gone> {
        let row = self.rows.iter_mut().find(|row| row.key == report.key);
        let Some(row) = row.filter(|_| report.group == self.group) else {
            return Err(if self.former.contains(&report.group) {
                Gone::Reset
            } else if self.removed.contains(&report.key) {
                Gone::Removed
            } else {
                Gone::Unknown
            });
        };
        let place = |at: &Option<At>| at.as_ref().map(|at| (at.name.clone(), at.step));
        let at = report.lesson.filter(At::is_valid);
        // A lost page makes no progress, but the student may continue without a connection.
        if place(&at) != place(&row.at) {
            row.since = now;
        }
        let names = report.finished.into_iter();
        row.finished = names.filter(|name| is_name(name)).take(LESSONS).collect();
        row.at = at;
        row.heard = now;
        row.is_hidden = report.hidden;
        // A page that was loaded again has forgotten its answers.
        row.answered = row.answered.max(report.answered);
        Ok(row.offer().cloned())
    }

    /// Offers a lesson to one student, or to all. Returns whether the row exists.
    pub(super) fn offer(&mut self, lesson: &str, id: Option<u32>) -> bool {
        self.offers += 1;
        let offer = Offer {
            number: self.offers,
            lesson: lesson.into(),
        };
        if id.is_none() {
            self.for_all = Some(offer.clone());
        }
        let mut found = id.is_none();
        for row in &mut self.rows {
            if id.is_none_or(|id| id == row.id) {
                row.offer = Some(offer.clone());
                found = true;
            }
        }
        found
    }

    /// Removes a row. Returns whether it exists.
    pub(super) fn remove(&mut self, id: u32) -> bool {
        let Some(place) = self.rows.iter().position(|row| row.id == id) else {
            return false;
        };
        remember(&mut self.removed, self.rows.remove(place).key);
        true
    }

    /// Removes all rows: the next group begins. `group` is its random name.
    pub(super) fn reset(&mut self, group: String) {
        remember(&mut self.former, std::mem::replace(&mut self.group, group));
        self.rows.clear();
        self.for_all = None;
        self.removed.clear();
    }

    /// The rows, in the order in which the students joined.
    pub(super) fn rows(&self, now: Instant) -> Vec<Shown<'_>> {
        let shown = |row| shown(row, now, self.patience);
        self.rows.iter().map(shown).collect()
    }
}

fn shown(row: &Row, now: Instant, patience: Duration) -> Shown<'_> {
    Shown {
        id: row.id,
        name: &row.name,
        presence: row.presence(now),
        silent: now.saturating_duration_since(row.heard).as_secs(),
        at: row.at.as_ref(),
        idle: now.saturating_duration_since(row.since).as_secs(),
        stuck: row.stuck(now, patience),
        finished: &row.finished,
        offer: row.offer().map(|offer| offer.lesson.as_str()),
    }
}

fn remember(all: &mut VecDeque<String>, one: String) {
    all.truncate(FORMER - 1);
    all.push_front(one);
}

#[cfg(test)]
mod tests {
    use super::*;

    const MINUTE: Duration = Duration::from_secs(60);

    fn room() -> (Room, Instant) {
        (Room::new("first".into(), 5 * MINUTE), Instant::now())
    }

    fn report(key: &str, step: u32, wrong: u32) -> Report {
        let lesson = Some(At {
            name: "nmt".into(),
            step,
            of: 4,
            wrong,
            hints: 0,
            shown: 0,
        });
        Report {
            key: key.into(),
            group: "first".into(),
            hidden: false,
            lesson,
            finished: Vec::new(),
            answered: 0,
        }
    }

    #[test]
    fn names_are_plain_short_and_unique() {
        let (mut room, now) = room();
        let joined = room
            .join("  Anna \t Ü. ", None, "a".into(), now)
            .expect("a name");
        assert_eq!(joined.name, "Anna Ü.");
        let long = "x".repeat(NAME + 1);
        for bad in ["", "  ", &long, "A\u{1b}[2J", "A\u{202e}B"] {
            assert_eq!(
                room.join(bad, None, "b".into(), now),
                Err(Refused::Name),
                "{bad:?}"
            );
        }
        assert_eq!(
            room.join("anna ü.", None, "b".into(), now),
            Err(Refused::Taken)
        );
        for number in 1..MOST {
            room.join(&format!("student {number}"), None, format!("{number}"), now)
                .expect("there is room");
        }
        assert_eq!(
            room.join("one more", None, "x".into(), now),
            Err(Refused::Full)
        );
    }

    #[test]
    fn a_lost_student_comes_back_to_the_same_row() {
        let (mut room, now) = room();
        room.join("Anna", None, "a".into(), now).expect("joined");
        room.report(report("a", 1, 0), now).expect("known");
        let later = now + LOST;
        assert_eq!(room.rows(later)[0].presence, Presence::Lost);
        room.join("Anna", None, "new".into(), later)
            .expect("her row");
        assert_eq!(room.rows(later).len(), 1);
        assert_eq!(room.rows(later)[0].at.map(|at| at.step), Some(1));
        assert_eq!(room.report(report("a", 1, 0), later), Err(Gone::Unknown));
        // She writes her name in another way, and then takes the row of a student who is lost.
        room.join("Anna B.", Some("new"), "b".into(), later)
            .expect("her row");
        room.join("Ben", None, "ben".into(), now).expect("joined");
        let names = |room: &Room| {
            room.rows(later)
                .iter()
                .map(|row| row.name.to_owned())
                .collect::<Vec<_>>()
        };
        assert_eq!(names(&room), ["Anna B.", "Ben"]);
        assert_eq!(room.rows(later)[0].at.map(|at| at.step), Some(1));
        room.join("ben", Some("b"), "new".into(), later)
            .expect("a lost row");
        assert_eq!(names(&room), ["ben"]);
        // A hidden tab reports seldom.
        let hidden = Report {
            hidden: true,
            ..report("new", 1, 0)
        };
        room.report(hidden, later).expect("known");
        let presence = |room: &Room, after| room.rows(later + after)[0].presence;
        assert_eq!(presence(&room, MINUTE), Presence::Hidden);
        assert_eq!(presence(&room, LOST_HIDDEN), Presence::Lost);
    }

    #[test]
    fn a_report_that_the_table_cannot_show_has_no_place_and_no_such_lessons() {
        let (mut room, now) = room();
        room.join("Anna", None, "a".into(), now).expect("joined");
        let mut place = |name: &str, step, of| {
            let lesson = Some(At {
                name: name.into(),
                of,
                ..report("a", step, 0).lesson.expect("a lesson")
            });
            let finished = vec![name.to_owned()];
            let report = Report {
                lesson,
                finished,
                ..report("a", 0, 0)
            };
            room.report(report, now).expect("known");
            let row = &room.rows(now)[0];
            (row.at.is_some(), row.finished.len())
        };
        assert_eq!(place("nmt", 4, 4), (true, 1));
        assert_eq!(place("nmt", 0, u32::MAX), (false, 1));
        assert_eq!(place("nmt", 5, 4), (false, 1));
        for name in ["\u{202e}tmn", "a\u{1b}[2J", "a\nb", &"x".repeat(LESSON + 1)] {
            assert_eq!(place(name, 0, 4), (false, 0), "{name:?}");
        }
    }

    #[test]
    fn a_student_without_progress_or_with_wrong_answers_is_stuck() {
        let (mut room, now) = room();
        room.join("Anna", None, "a".into(), now).expect("joined");
        let mut at = |minutes, step, wrong| {
            let now = now + MINUTE * minutes;
            room.report(report("a", step, wrong), now).expect("known");
            room.rows(now)[0].stuck
        };
        assert_eq!(at(0, 0, 0), None);
        assert_eq!(at(4, 0, 2), None);
        assert_eq!(at(4, 0, WRONG), Some(Stuck::Wrong));
        assert_eq!(at(5, 0, 0), Some(Stuck::Time));
        assert_eq!(at(6, 1, 0), None, "a step is progress");
        assert_eq!(at(11, 1, 0), Some(Stuck::Time));
        assert_eq!(at(20, 4, 0), None);
        assert_eq!(at(60, 4, 0), None, "the lesson is done");
    }

    #[test]
    fn an_offer_waits_for_an_answer() {
        let (mut room, now) = room();
        for key in ["a", "b"] {
            room.join(key, None, key.into(), now).expect("joined");
        }
        assert!(room.offer("sdo", Some(1)) && !room.offer("sdo", Some(7)));
        assert_eq!(room.report(report("b", 0, 0), now), Ok(None));
        let offer = room.report(report("a", 0, 0), now).expect("known");
        let number = offer.map(|offer| offer.number).expect("an offer");
        assert_eq!(room.rows(now)[0].offer, Some("sdo"));
        let answered = Report {
            answered: number,
            ..report("a", 0, 0)
        };
        assert_eq!(room.report(answered, now), Ok(None));
        assert_eq!(
            room.report(report("a", 0, 0), now),
            Ok(None),
            "loaded again"
        );
        assert_eq!(room.rows(now)[0].offer, None);
        assert!(room.offer("nmt", None));
        assert!(room.rows(now).iter().all(|row| row.offer == Some("nmt")));
        room.join("late", None, "c".into(), now).expect("joined");
        assert_eq!(room.rows(now)[2].offer, Some("nmt"), "an offer to all");
        room.reset("second".into());
        room.join("next", None, "d".into(), now).expect("joined");
        assert_eq!(room.rows(now)[0].offer, None, "another group");
    }

    #[test]
    fn a_page_learns_why_its_row_is_gone() {
        let (mut room, now) = room();
        for key in ["a", "b"] {
            room.join(key, None, key.into(), now).expect("joined");
        }
        assert!(room.remove(1) && !room.remove(1));
        assert_eq!(room.report(report("a", 0, 0), now), Err(Gone::Removed));
        room.reset("second".into());
        assert_eq!(room.report(report("b", 0, 0), now), Err(Gone::Reset));
        assert!(room.rows(now).is_empty());
        let restarted = &mut Room::new("other".into(), MINUTE);
        assert_eq!(restarted.report(report("b", 0, 0), now), Err(Gone::Unknown));
    }
}
