//! The console of `odkit monitor`, on a terminal.

use std::collections::VecDeque;
use std::io::{self, Stdout, Write};
use std::path::Path;
use std::time::Duration;

use crossterm::event::{self, Event, KeyCode, KeyEvent, KeyEventKind, KeyModifiers};
use crossterm::style::Print;
use crossterm::terminal::{self, Clear, ClearType, EnterAlternateScreen, LeaveAlternateScreen};
use crossterm::{cursor, execute, queue};
use od_model::Visible;
use od_sim::words::Service;
use od_tools::Error;
use od_tools::filter::{Filter, FilteredFrame};
use od_tools::link::Link;
use od_wire::Instant;

use super::stats::Stats;
use crate::bus::Bus;
use crate::bus::words::{ExplainedFrame, Narrator};
use crate::failure::Failure;
use crate::record::Recorder;

/// Maximum number of frames in the history.
const KEPT: usize = 5000;
/// Time between two refreshes, in ms.
const PAUSE: u64 = 100;
/// Maximum wait for a frame before keys are read, in ms.
const KEYS: u64 = 20;

/// Settings of the display.
pub(super) struct View {
    pub(super) title: String,
    /// In kbit/s.
    pub(super) rate: u16,
    pub(super) by_id: bool,
    pub(super) filter: Filter,
    pub(super) filter_text: String,
}

/// A terminal in raw mode; its mode is restored when this is dropped.
struct Screen(Stdout);

impl Screen {
    fn open() -> io::Result<Self> {
        terminal::enable_raw_mode()?;
        let mut screen = Self(io::stdout());
        execute!(screen.0, EnterAlternateScreen, cursor::Hide)?;
        Ok(screen)
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        // If the terminal is gone, nothing can be restored.
        let _ = execute!(self.0, cursor::Show, LeaveAlternateScreen);
        let _ = terminal::disable_raw_mode();
    }
}

/// State of the console.
struct Console<'r> {
    view: View,
    stats: Stats,
    frames: VecDeque<ExplainedFrame>,
    /// The last EMCY message in words.
    emcy: Option<String>,
    is_paused: bool,
    /// Number of frames that the display is scrolled back.
    back: usize,
    /// The filter that is being typed.
    typed: Option<String>,
    /// A message for the last line.
    said: Option<String>,
    recorder: &'r mut Option<Recorder>,
}

pub(super) fn run(
    mut bus: Bus,
    mut narrator: Narrator,
    view: View,
    recorder: &mut Option<Recorder>,
    until: Instant,
) -> Result<(), Failure> {
    let mut console = Console {
        view,
        stats: Stats::default(),
        frames: VecDeque::new(),
        emcy: None,
        is_paused: false,
        back: 0,
        typed: None,
        said: None,
        recorder,
    };
    let mut screen = Screen::open()?;
    let mut next = Instant::ZERO;
    loop {
        let now = bus.now();
        if now >= until {
            return Ok(());
        }
        match bus.receive(now.plus_millis(KEYS)) {
            Ok(Some(heard)) => {
                if let Some(recorder) = console.recorder.as_mut() {
                    recorder.add(heard.at, &heard.frame)?;
                }
                if let Some(told) = narrator.tell(heard.at, heard.frame, false) {
                    console.add(told);
                }
            }
            Ok(None) => {}
            Err(Error::Interrupted) => return Ok(()),
            Err(fault) => return Err(fault.into()),
        }
        let now = bus.now();
        if now < next {
            continue;
        }
        next = now.plus_millis(PAUSE);
        while event::poll(Duration::ZERO)? {
            if let Event::Key(key) = event::read()?
                && key.kind != KeyEventKind::Release
                && console.key(key)
            {
                return Ok(());
            }
        }
        console.draw(&mut screen.0, now)?;
    }
}

impl Console<'_> {
    fn add(&mut self, told: ExplainedFrame) {
        self.stats.add(&told);
        if told.words.service == Service::Emcy {
            self.emcy = Some(told.line());
        }
        if self.is_paused {
            return;
        }
        self.frames.push_back(told);
        if self.frames.len() > KEPT {
            self.frames.pop_front();
        }
    }

    /// Handles a key. Returns whether it ends the console.
    fn key(&mut self, key: KeyEvent) -> bool {
        let is_control = key.modifiers.contains(KeyModifiers::CONTROL);
        if is_control && matches!(key.code, KeyCode::Char('c' | 'd')) {
            return true;
        }
        if self.typed.is_some() {
            self.type_filter(key.code);
            return false;
        }
        self.said = None;
        match key.code {
            KeyCode::Char('q') | KeyCode::Esc => return true,
            KeyCode::Char(' ') => self.is_paused = !self.is_paused,
            KeyCode::Tab | KeyCode::Char('i') => {
                self.view.by_id = !self.view.by_id;
                self.back = 0;
            }
            KeyCode::Char('/') => self.typed = Some(self.view.filter_text.clone()),
            KeyCode::Char('r') => self.record(),
            KeyCode::Char('c') => {
                self.frames.clear();
                self.stats = Stats::default();
                self.emcy = None;
            }
            KeyCode::Up => self.back += 1,
            KeyCode::Down => self.back = self.back.saturating_sub(1),
            KeyCode::PageUp => self.back += 20,
            KeyCode::PageDown => self.back = self.back.saturating_sub(20),
            KeyCode::End => self.back = 0,
            _ => {}
        }
        self.back = self.back.min(self.frames.len());
        false
    }

    fn type_filter(&mut self, key: KeyCode) {
        let Some(typed) = &mut self.typed else { return };
        match key {
            KeyCode::Char(c) => typed.push(c),
            KeyCode::Backspace => drop(typed.pop()),
            KeyCode::Esc => {
                self.typed = None;
                self.said = None;
            }
            KeyCode::Enter => match Filter::parse(typed) {
                Ok(filter) => {
                    self.view.filter = filter;
                    self.view.filter_text = self.typed.take().unwrap_or_default();
                    self.said = None;
                }
                Err(mistake) => self.said = Some(mistake.to_string()),
            },
            _ => {}
        }
    }

    /// Starts or stops a recording.
    fn record(&mut self) {
        let done = match self.recorder.take() {
            Some(recorder) => recorder.finish(),
            None => {
                // A file name that is free.
                let names = (1..).map(|number| format!("monitor-{number}.log"));
                let name = names.into_iter().find(|name| !Path::new(name).exists());
                let name = name.unwrap_or_default();
                Recorder::create(Path::new(&name)).map(|recorder| {
                    *self.recorder = Some(recorder);
                    format!("recording to {name}")
                })
            }
        };
        self.said = Some(done.unwrap_or_else(|failure| failure.to_string()));
    }

    fn draw(&mut self, out: &mut Stdout, now: Instant) -> Result<(), Failure> {
        let (width, height) = terminal::size()?;
        let (width, height) = (usize::from(width), usize::from(height));
        let rows = height.saturating_sub(3);
        let mut lines = vec![self.head(now)];
        let body = if self.view.by_id {
            let table = self.stats.filtered(&self.view.filter);
            let head = table.first().cloned();
            let rest = table.into_iter().skip(1).skip(self.back);
            head.into_iter().chain(rest).take(rows).collect()
        } else {
            self.newest(rows)
        };
        lines.extend(body);
        lines.resize(rows + 1, String::new());
        lines.push(self.emcy.clone().unwrap_or_default());
        lines.push(self.foot());
        for (y, line) in (0_u16..).zip(lines.iter().take(height)) {
            let shown: String = Visible(line).line().chars().take(width).collect();
            queue!(
                out,
                cursor::MoveTo(0, y),
                Print(shown),
                Clear(ClearType::UntilNewLine)
            )?;
        }
        out.flush()?;
        Ok(())
    }

    /// The last frames that pass the filter, in order.
    fn newest(&self, rows: usize) -> Vec<String> {
        let passing = self.frames.iter().rev().filter(|told| {
            let words = told.words.to_string();
            self.view.filter.passes(&FilteredFrame {
                frame: &told.frame,
                sent: told.sent,
                words: &words,
            })
        });
        let mut lines: Vec<String> = passing
            .skip(self.back)
            .take(rows)
            .map(ExplainedFrame::line)
            .collect();
        lines.reverse();
        lines
    }

    fn head(&mut self, now: Instant) -> String {
        let load = self.stats.load(now, self.view.rate);
        let mut head = format!(
            "{}  {} frames  load {load:.1} % of {} kbit/s",
            self.view.title, self.stats.count, self.view.rate
        );
        if !self.view.filter_text.is_empty() {
            head.push_str(&format!("  filter: {}", self.view.filter_text));
        }
        if let Some(recorder) = &self.recorder {
            head.push_str(&format!("  recorded {}", recorder.count));
        }
        if self.is_paused {
            head.push_str("  PAUSED");
        }
        head
    }

    fn foot(&self) -> String {
        match (&self.typed, &self.said) {
            (Some(typed), None) => format!("filter: {typed}_"),
            (Some(typed), Some(said)) => format!("filter: {typed}_  {said}"),
            (None, Some(said)) => said.clone(),
            (None, None) => {
                "q quit  Tab by COB-ID  / filter  Space pause  r record  c clear  ↑↓ scroll".into()
            }
        }
    }
}
