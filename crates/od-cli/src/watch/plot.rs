//! Values over time on a terminal.

use std::collections::VecDeque;

use od_model::Visible;
use od_wire::Instant;

use crate::output;

/// Columns of the plot.
const WIDTH: usize = 64;
/// Rows of all plots together.
const ROWS: usize = 16;
/// Minimum time between two refreshes, in ms.
const PAUSE: u64 = 100;
const BARS: [char; 9] = [' ', '▁', '▂', '▃', '▄', '▅', '▆', '▇', '█'];

/// A plot for each value.
pub(super) struct Plot {
    series: Vec<Series>,
    /// Number of lines of the current display.
    lines: usize,
    drawn: Option<Instant>,
}

struct Series {
    title: String,
    text: String,
    values: VecDeque<f64>,
}

impl Plot {
    pub(super) fn new(titles: Vec<String>) -> Self {
        let series = titles.into_iter().map(|title| Series {
            title,
            text: String::new(),
            values: VecDeque::new(),
        });
        Self {
            series: series.collect(),
            lines: 0,
            drawn: None,
        }
    }

    /// Adds a value, and draws if the last refresh is long enough ago. A value that is not a number is not
    /// drawn.
    pub(super) fn add(&mut self, series: usize, at: Instant, text: String, value: Option<f64>) {
        if let Some(one) = self.series.get_mut(series) {
            one.text = text;
            one.values.extend(value);
            while one.values.len() > WIDTH {
                one.values.pop_front();
            }
        }
        if self
            .drawn
            .is_none_or(|drawn| at >= drawn.plus_millis(PAUSE))
        {
            self.drawn = Some(at);
            self.draw();
        }
    }

    fn draw(&mut self) {
        let rows = (ROWS / self.series.len().max(1)).max(1);
        let mut picture = Vec::new();
        for one in &self.series {
            picture.push(format!("{}  {}", Visible(&one.title), Visible(&one.text)));
            picture.extend(draw(one.values.iter().copied().collect(), rows));
        }
        let mut text = String::new();
        if self.lines > 0 {
            // Moves the cursor to the first line of the last display.
            text.push_str(&format!("\x1b[{}A", self.lines));
        }
        for line in &picture {
            text.push_str(&format!("\r{line}\x1b[K\n"));
        }
        self.lines = picture.len();
        let _ = output::print_raw(&text);
    }
}

/// Bars between the lowest and the highest value, with both printed beside them.
fn draw(values: Vec<f64>, rows: usize) -> Vec<String> {
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let span = if high > low { high - low } else { 1.0 };
    let steps = (rows * 8) as f64;
    let heights: Vec<usize> = values
        .iter()
        .map(|value| ((value - low) / span * (steps - 1.0)) as usize + 1)
        .collect();
    (0..rows)
        .rev()
        .map(|row| {
            let bars = heights
                .iter()
                .map(|height| BARS[height.saturating_sub(row * 8).min(8)]);
            let bars: String = bars.collect();
            let label = match row {
                _ if values.is_empty() => String::new(),
                row if row + 1 == rows => high.to_string(),
                0 => low.to_string(),
                _ => String::new(),
            };
            format!("{bars:<WIDTH$} {label}")
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lowest_value_has_the_lowest_bar() {
        let lines = draw(vec![0.0, 5.0, 10.0], 2);
        assert!(
            lines[0].starts_with("  █") && lines[0].ends_with("10"),
            "{lines:?}"
        );
        assert!(
            lines[1].starts_with("▁█") || lines[1].starts_with("▁"),
            "{lines:?}"
        );
        assert!(lines[1].ends_with(" 0"), "{lines:?}");
        assert_eq!(draw(Vec::new(), 3).len(), 3);
        assert_eq!(draw(vec![7.0; 100], 1).len(), 1);
    }
}
