//! What each step takes of the processor and of the clock.

use std::time::Instant;

use xtask::shell::{Outcome, say};

/// Units of time of the processor in a second, as Linux tells them to programs (`USER_HZ`, the same on all machines).
const TICKS: f64 = 100.0;
/// Where a process's line in `/proc` has the time of its children that have ended, by themselves and in the system: fields
/// after the name, which ends with a bracket.
const OF_CHILDREN: [usize; 2] = [13, 14];

/// The steps so far.
#[derive(Debug, Default)]
pub(crate) struct Minutes {
    rows: Vec<(&'static str, f64, Option<f64>)>,
}

impl Minutes {
    /// Takes a step.
    pub(crate) fn of<T>(&mut self, step: &'static str, take: impl FnOnce() -> Outcome<T>) -> Outcome<T> {
        let (started, before) = (Instant::now(), processor());
        let outcome = take();
        let spent = processor().zip(before).map(|(after, before)| after - before);
        self.rows.push((step, started.elapsed().as_secs_f64(), spent));
        outcome
    }

    /// Shows them.
    pub(crate) fn tell(&self) {
        say("\nminutes of  the processor  the clock");
        for (step, wall, spent) in &self.rows {
            let spent = spent.map_or_else(|| "-".to_owned(), |s| format!("{:.1}", s / 60.0));
            say(&format!("{spent:>24}  {:>9.1}  {step}", wall / 60.0));
        }
    }
}

/// Seconds of the processor that the programs have taken that this one called and that have ended; none where the system
/// does not tell.
fn processor() -> Option<f64> {
    let line = std::fs::read_to_string("/proc/self/stat").ok()?;
    children(&line)
}

/// The same in the line of a process.
fn children(line: &str) -> Option<f64> {
    let (_, fields) = line.rsplit_once(')')?;
    let fields: Vec<&str> = fields.split_whitespace().collect();
    let ticks = OF_CHILDREN.map(|k| fields.get(k).and_then(|f| f.parse::<f64>().ok()));
    Some((ticks[0]? + ticks[1]?) / TICKS)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_time_of_children_is_found_after_any_name() {
        let line = "7 (a (b) c) S 1 2 3 4 5 6 7 8 9 10 600 40 12050 350 20 0 1";
        assert_eq!(children(line), Some(124.0));
        assert_eq!(children("7 (cut) S 1 2"), None);
    }
}
