//! Measures how fast stands grow, and how realistic they are: `cargo run --release --example stands -p burgeon-forest
//! [speed | truth FOLDER]`.
//!
//! `speed` lets forests of 10,000 to a million trees grow for 50 years on two threads, and reports time and memory.
//! `truth` draws the plots of `docs/forests.md` into a folder.

use std::fmt::Write as _;
use std::path::Path;
use std::time::Instant;

use base::{Executor, Run, Seed, ops};
use forest::{ForestSpec, Ground, GrownStand, Site, SpeciesSpec, StandYear, grow_stand_on};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    match words.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["truth", folder] => truth(Path::new(folder)),
        _ => speed(),
    }
}

/// Two threads, each of which takes the next job.
struct TwoThreads;

impl Executor for TwoThreads {
    fn for_each(&self, n: usize, job: &(dyn Fn(usize) + Sync)) {
        let next = std::sync::atomic::AtomicUsize::new(0);
        let work = || {
            loop {
                let k = next.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
                if k >= n {
                    return;
                }
                job(k);
            }
        };
        std::thread::scope(|scope| {
            scope.spawn(work);
            work();
        });
    }
}

/// Returns the processor time of all threads of this process in seconds, and its peak memory in MiB; 0 if the system
/// does not report them.
fn used() -> (f64, u64) {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let fields: Vec<&str> = stat.rsplit(')').next().unwrap_or_default().split_whitespace().collect();
    let ticks = |k: usize| fields.get(k).and_then(|t| t.parse::<f64>().ok()).unwrap_or(0.0);
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let peak = status.lines().find_map(|l| l.strip_prefix("VmHWM:")?.split_whitespace().next()?.parse().ok());
    // After the program's name, user and system time are the 12th and 13th field, in hundredths of a second.
    ((ticks(11) + ticks(12)) / 100.0, peak.unwrap_or(0_u64) / 1024)
}

fn mixed(side_m: f64, density_ha: f64) -> ForestSpec {
    let species = |name: &str, share| SpeciesSpec { name: name.into(), share, ..SpeciesSpec::default() };
    ForestSpec {
        area_m: [side_m, side_m],
        density_ha,
        species: vec![
            species("spruce", 1.0),
            species("beech", 1.0),
            species("pine", 0.5),
            species("birch", 0.5),
        ],
        ..ForestSpec::default()
    }
}

#[expect(clippy::print_stdout, reason = "this is a program for the terminal")]
fn speed() -> Result<(), Box<dyn std::error::Error>> {
    let run = Run { executor: &TwoThreads, ..Run::plain() };
    println!("| area | trees placed | trees after 50 years | processor | clock | most memory |");
    println!("|---|---|---|---|---|---|");
    // Open forest at 100 trees a hectare, and thickets of 3,000.
    for (side_m, density_ha) in [
        (1_000.0, 100.0),
        (3_162.0, 100.0),
        (10_000.0, 100.0),
        (183.0, 3000.0),
        (577.0, 3000.0),
        (1_826.0, 3000.0),
    ] {
        let spec = mixed(side_m, density_ha);
        let site = Site { ground: &Ground::Flat, masks: &[] };
        let (before, clock) = (used().0, Instant::now());
        let GrownStand { stand, history, .. } = grow_stand_on(&spec, &site, Seed::new(1), &run)?;
        // The system counts in hundredths of a second: small forests grow several times.
        let rounds = (300_000 / history[0].trees.max(1)).clamp(1, 40);
        for _ in 1..rounds {
            grow_stand_on(&spec, &site, Seed::new(1), &run)?;
        }
        let (after, peak) = used();
        let rounds = rounds as f64;
        println!(
            "| {:.2} x {:.2} km | {} | {} | {:.3} s | {:.2} s | {peak} MiB |",
            side_m / 1000.0,
            side_m / 1000.0,
            base::grouped(history[0].trees as u64),
            base::grouped(stand.trees.len() as u64),
            (after - before) / rounds,
            clock.elapsed().as_secs_f64() / rounds
        );
    }
    Ok(())
}

/// Species of the plots, and their colours.
const KINDS: [(&str, &str); 4] =
    [("pine", "#c26a1b"), ("spruce", "#2f6b4f"), ("beech", "#7a4fb0"), ("oak", "#2a5fa5")];

fn truth(folder: &Path) -> Result<(), Box<dyn std::error::Error>> {
    let run = Run { executor: &TwoThreads, ..Run::plain() };
    let mut stands = Vec::new();
    for (name, colour) in KINDS {
        let species = SpeciesSpec { name: name.into(), seedlings: 0.0, ..SpeciesSpec::default() };
        let spec = ForestSpec {
            area_m: [300.0, 300.0],
            density_ha: 6000.0,
            years: 80,
            species: vec![species],
            ..ForestSpec::default()
        };
        let site = Site { ground: &Ground::Flat, masks: &[] };
        stands.push((name, colour, grow_stand_on(&spec, &site, Seed::new(1), &run)?));
    }
    std::fs::create_dir_all(folder)?;
    std::fs::write(folder.join("self-thinning.svg"), self_thinning(&stands))?;
    std::fs::write(folder.join("basal-area.svg"), basal_area(&stands))?;
    std::fs::write(folder.join("diameters.svg"), diameters(&stands))?;
    Ok(())
}

type Named = (&'static str, &'static str, GrownStand);

/// A plot with axes, and the mapping from numbers to the paper.
struct Plot {
    svg: String,
    x: [f64; 2],
    y: [f64; 2],
    legend: f64,
}

const SIZE: [f64; 2] = [640.0, 420.0];
const MARGIN: [f64; 4] = [64.0, 16.0, 20.0, 52.0];

impl Plot {
    fn new(title: [&str; 2], x: [f64; 2], y: [f64; 2], ticks: [&[(f64, &str)]; 2]) -> Self {
        let [width, height] = SIZE;
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" font-family=\"sans-serif\" font-size=\"13\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
        );
        let mut plot = Self { svg: String::new(), x, y, legend: MARGIN[2] + 16.0 };
        for &(v, label) in ticks[0] {
            let [px, py] = plot.position(v, y[0]);
            let top = plot.position(v, y[1])[1];
            let _ = writeln!(
                svg,
                "<path d=\"M{px:.1} {py:.1}V{top:.1}\" stroke=\"#ddd\"/><text x=\"{px:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{label}</text>",
                py + 18.0
            );
        }
        for &(v, label) in ticks[1] {
            let [px, py] = plot.position(x[0], v);
            let right = plot.position(x[1], v)[0];
            let _ = writeln!(
                svg,
                "<path d=\"M{px:.1} {py:.1}H{right:.1}\" stroke=\"#ddd\"/><text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{label}</text>",
                px - 6.0,
                py + 4.0
            );
        }
        let middle = 0.5 * (height - MARGIN[3] + MARGIN[2]);
        let _ = writeln!(
            svg,
            "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>",
            0.5 * width,
            height - 12.0,
            title[0]
        );
        let _ = writeln!(
            svg,
            "<text transform=\"translate(16 {middle:.1}) rotate(-90)\" text-anchor=\"middle\">{}</text>",
            title[1]
        );
        plot.svg = svg;
        plot
    }

    fn position(&self, x: f64, y: f64) -> [f64; 2] {
        let share = |v: f64, [low, high]: [f64; 2]| (v - low) / (high - low);
        [
            MARGIN[0] + share(x, self.x) * (SIZE[0] - MARGIN[0] - MARGIN[1]),
            SIZE[1] - MARGIN[3] - share(y, self.y) * (SIZE[1] - MARGIN[2] - MARGIN[3]),
        ]
    }

    fn line(&mut self, points: &[[f64; 2]], colour: &str, dashes: &str, name: &str) {
        let path: Vec<String> =
            points.iter().map(|p| self.position(p[0], p[1])).map(|[x, y]| format!("{x:.1},{y:.1}")).collect();
        let _ = writeln!(
            self.svg,
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"2\" stroke-dasharray=\"{dashes}\"/>",
            path.join(" ")
        );
        let (x, y) = (SIZE[0] - 210.0, self.legend);
        let _ = writeln!(
            self.svg,
            "<path d=\"M{x} {y}h24\" stroke=\"{colour}\" stroke-width=\"2\" stroke-dasharray=\"{dashes}\"/><text x=\"{}\" y=\"{}\">{name}</text>",
            x + 32.0,
            y + 4.0
        );
        self.legend += 18.0;
    }

    fn band(&mut self, low: [f64; 2], high: [f64; 2], name: &str) {
        let ([x0, y0], [x1, y1]) = (self.position(low[0], high[1]), self.position(high[0], low[1]));
        let _ = writeln!(
            self.svg,
            "<rect x=\"{x0:.1}\" y=\"{y0:.1}\" width=\"{:.1}\" height=\"{:.1}\" fill=\"#c26a1b\" opacity=\"0.15\"/><text x=\"{:.1}\" y=\"{:.1}\" fill=\"#8a4a10\">{name}</text>",
            x1 - x0,
            y1 - y0,
            x0 + 8.0,
            y0 + 16.0
        );
    }

    fn finished(self) -> String {
        self.svg + "</svg>\n"
    }
}

fn slope(points: &[[f64; 2]]) -> f64 {
    let n = points.len() as f64;
    let mean = |k: usize| points.iter().map(|p| p[k]).sum::<f64>() / n;
    let (mx, my) = (mean(0), mean(1));
    let products: f64 = points.iter().map(|p| (p[0] - mx) * (p[1] - my)).sum();
    products / points.iter().map(|p| (p[0] - mx) * (p[0] - mx)).sum::<f64>()
}

fn self_thinning(stands: &[Named]) -> String {
    let ln = |v: f64| ops::ln(v);
    let dbh = [(ln(3.0), "3"), (ln(5.0), "5"), (ln(10.0), "10"), (ln(20.0), "20"), (ln(40.0), "40")];
    let trees = [
        (ln(200.0), "200"),
        (ln(500.0), "500"),
        (ln(1000.0), "1000"),
        (ln(2000.0), "2000"),
        (ln(5000.0), "5000"),
    ];
    let title =
        ["diameter of the tree of mean basal area, cm (logarithmic)", "trees per hectare (logarithmic)"];
    let mut plot = Plot::new(title, [ln(2.5), ln(50.0)], [ln(150.0), ln(7000.0)], [&dbh, &trees]);
    let point = |y: &StandYear| [ln(100.0 * y.mean_dbh_m), ln(y.trees_ha)];
    for (name, colour, grown) in stands {
        let seen: Vec<[f64; 2]> = grown.history.iter().map(point).filter(|p| p[0] > ln(2.5)).collect();
        let full: Vec<[f64; 2]> =
            grown.history.iter().filter(|y| (25..=80).contains(&y.year)).map(point).collect();
        plot.line(&seen, colour, "", &format!("{name}: {:.2}", slope(&full)));
    }
    let from = ln(900.0);
    plot.line(
        &[[ln(9.0), from + 1.605 * ln(25.0 / 9.0)], [ln(45.0), from - 1.605 * ln(45.0 / 25.0)]],
        "#888",
        "6 4",
        "Reineke (1933): -1.605",
    );
    plot.finished()
}

fn basal_area(stands: &[Named]) -> String {
    let years = [(20.0, "20"), (40.0, "40"), (60.0, "60"), (80.0, "80")];
    let areas = [(10.0, "10"), (20.0, "20"), (30.0, "30"), (40.0, "40"), (50.0, "50"), (60.0, "60")];
    let title = ["years", "basal area, square metres per hectare"];
    let mut plot = Plot::new(title, [0.0, 80.0], [0.0, 75.0], [&years, &areas]);
    plot.band([22.0, 8.7], [80.0, 56.5], "250 plots of pine (Kuehne et al. 2022)");
    for (name, colour, grown) in stands {
        let points: Vec<[f64; 2]> =
            grown.history.iter().map(|y| [f64::from(y.year), y.basal_area_m2_ha]).collect();
        plot.line(&points, colour, "", name);
    }
    plot.finished()
}

fn diameters(stands: &[Named]) -> String {
    /// Width of a class of diameters, metres.
    const CLASS_M: f64 = 0.04;
    let sizes =
        [(0.0, "0"), (10.0, "10"), (20.0, "20"), (30.0, "30"), (40.0, "40"), (50.0, "50"), (60.0, "60")];
    let shares = [(0.0, "0"), (0.1, "10"), (0.2, "20"), (0.3, "30")];
    let title = ["diameter after 80 years, cm", "share of the trees, %"];
    let mut plot = Plot::new(title, [0.0, 70.0], [0.0, 0.35], [&sizes, &shares]);
    for (name, colour, grown) in stands {
        let trees = &grown.stand.trees;
        let class = |k: u32| trees.iter().filter(|t| ops::whole(t.dbh_m / CLASS_M) == k).count();
        let points: Vec<[f64; 2]> = (0..17)
            .map(|k| [100.0 * CLASS_M * (f64::from(k) + 0.5), class(k) as f64 / trees.len() as f64])
            .collect();
        plot.line(&points, colour, "", name);
    }
    plot.finished()
}
