//! Time of each step, on the processor and by the clock.

use std::time::Instant;

use xtask::shell::{Outcome, say};

/// Units of processor time in a second, as Linux reports them (`USER_HZ`, the same on all machines).
const TICKS: f64 = 100.0;
/// Fields of a process's line in `/proc` with the time of its children that have ended, in user and in system mode:
/// counted after the name, which ends with a bracket.
const OF_CHILDREN: [usize; 2] = [13, 14];

/// Steps so far.
#[derive(Debug, Default)]
pub(crate) struct Minutes {
    rows: Vec<(&'static str, f64, Option<f64>)>,
}

impl Minutes {
    /// Runs a step and measures it.
    pub(crate) fn measure<T>(&mut self, step: &'static str, take: impl FnOnce() -> Outcome<T>) -> Outcome<T> {
        let (started, before) = (Instant::now(), processor());
        let outcome = take();
        let spent = processor().zip(before).map(|(after, before)| after - before);
        self.rows.push((step, started.elapsed().as_secs_f64(), spent));
        outcome
    }

    /// Prints the steps.
    pub(crate) fn tell(&self) {
        say("\nminutes of  the processor  the clock");
        for (step, wall, spent) in &self.rows {
            let spent = spent.map_or_else(|| "-".to_owned(), |s| format!("{:.1}", s / 60.0));
            say(&format!("{spent:>24}  {:>9.1}  {step}", wall / 60.0));
        }
    }
}

/// Returns the processor time in seconds of ended programs that this one called; `None` where the system does not
/// report it.
fn processor() -> Option<f64> {
    let line = std::fs::read_to_string("/proc/self/stat").ok()?;
    children(&line)
}

/// Returns the same from the line of a process.
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
