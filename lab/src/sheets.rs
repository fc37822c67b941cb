//! `cargo xtask sheets`: a page for each species, for inspection: nine seeds, four ages, three levels of detail.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use serde_json::Value;

use crate::pixels::{Pixels, rgba, tiled, write_rgb};
use xtask::shell::{Outcome, built_burgeon, command, output, prepare, repository, say};

/// Side of a picture, pixels.
const SIDE: usize = 240;
/// Number of pictures in a row.
const COLUMNS: usize = 4;
/// Number of seeds.
const SEEDS: u32 = 9;
/// Number of levels of detail.
const LEVELS: u32 = 3;
/// Ages of the first seed, as shares of the years of its species.
const SHARES: [f64; 4] = [0.12, 0.25, 0.5, 0.75];
/// Grey of the background.
const PAPER: u8 = 232;
/// Side of a dot of a letter, pixels.
const DOT: usize = 2;

/// Letters of three by five dots, row by row from the top, the leftmost dot first; four bits unused.
const LETTERS: [(char, u16); 37] = [
    ('0', 0o75557),
    ('1', 0o26227),
    ('2', 0o71747),
    ('3', 0o71717),
    ('4', 0o55711),
    ('5', 0o74717),
    ('6', 0o74757),
    ('7', 0o71122),
    ('8', 0o75757),
    ('9', 0o75717),
    ('a', 0o25755),
    ('b', 0o65656),
    ('c', 0o34443),
    ('d', 0o65556),
    ('e', 0o74647),
    ('f', 0o74644),
    ('g', 0o34553),
    ('h', 0o55755),
    ('i', 0o72227),
    ('j', 0o11152),
    ('k', 0o55655),
    ('l', 0o44447),
    ('m', 0o57755),
    ('n', 0o65555),
    ('o', 0o25552),
    ('p', 0o65644),
    ('q', 0o25563),
    ('r', 0o65655),
    ('s', 0o34216),
    ('t', 0o72222),
    ('u', 0o55557),
    ('v', 0o55552),
    ('w', 0o55775),
    ('x', 0o55255),
    ('y', 0o55222),
    ('z', 0o71247),
    ('-', 0o00700),
];

/// Makes the pages of the given species, or of all.
pub(crate) fn run(only: &[String]) -> Outcome {
    let burgeon = built_burgeon()?;
    let list = output(prepare(&burgeon, &["presets", "--json"]))?;
    let list: Value = serde_json::from_str(&list).map_err(|e| e.to_string())?;
    let trees = list.as_array().into_iter().flatten().filter(|row| row["method"] != "flower");
    let keys: Vec<&str> = trees.filter_map(|row| row["preset"].as_str()).collect();
    if let Some(other) = only.iter().find(|k| !keys.contains(&k.as_str())) {
        return Err(format!("no such species: {other}"));
    }
    let keys: Vec<&str> =
        keys.into_iter().filter(|k| only.is_empty() || only.iter().any(|o| o == k)).collect();
    let to = repository().join("out/sheets");
    std::fs::create_dir_all(&to).map_err(|e| format!("cannot make {}: {e}", to.display()))?;
    // Several species at a time, each on one thread: much of the work of a small picture cannot be divided.
    let next = AtomicUsize::new(0);
    let work = || -> Outcome {
        while let Some(key) = keys.get(next.fetch_add(1, Ordering::Relaxed)) {
            page(&burgeon, key, &to)?;
        }
        Ok(())
    };
    let workers = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        let workers: Vec<_> = (0..workers).map(|_| scope.spawn(work)).collect();
        workers.into_iter().try_for_each(|w| w.join().map_err(|_panic| "a worker panicked".to_owned())?)
    })?;
    say(&format!("{} pages in {}", keys.len(), to.display()));
    Ok(())
}

fn page(burgeon: &Path, key: &str, to: &Path) -> Outcome {
    let folder = std::env::temp_dir().join(format!("burgeon-sheet-{}-{key}", std::process::id()));
    std::fs::create_dir_all(&folder).map_err(|e| format!("cannot make {}: {e}", folder.display()))?;
    let made = pictures(burgeon, key, &folder).and_then(|mut all| {
        let blank = folder.join("blank.png");
        write_rgb(&[[PAPER; 3]; SIDE * SIDE], SIDE, SIDE, &blank)?;
        all.resize(all.len().next_multiple_of(COLUMNS), blank);
        tiled(&all.chunks(COLUMNS).map(<[_]>::to_vec).collect::<Vec<_>>(), &to.join(format!("{key}.png")))
    });
    let _ = std::fs::remove_dir_all(&folder);
    made
}

/// Makes the pictures of a species, each with its label.
fn pictures(burgeon: &Path, key: &str, folder: &Path) -> Outcome<Vec<PathBuf>> {
    let place = |name: String| folder.join(name).display().to_string();
    let size = format!("{SIDE}x{SIDE}");
    let drawn = ["--size", &size, "--threads", "1", "--quiet"];
    let mut made = Vec::new();
    let mut keep = |label: String, png: String| -> Outcome {
        let path = PathBuf::from(png);
        write_rgb(&labelled(&rgba(&path)?, &label), SIDE, SIDE, &path)?;
        made.push(path);
        Ok(())
    };
    let grow =
        |more: &[&str]| command(burgeon, &[&["grow", key, "--textures", "128"], more, &drawn].concat());
    for seed in 1..=SEEDS {
        let png = place(format!("seed-{seed}.png"));
        grow(&["--seed", &seed.to_string(), "--png", &png])?;
        keep(format!("{key} {seed}"), png)?;
    }
    let years = years(burgeon, key)?;
    let mut ages = SHARES.map(|share| (share * years).round().to_string()).to_vec();
    ages.dedup();
    let whole = years.to_string();
    for age in ages.into_iter().filter(|age| *age != "0" && *age != whole) {
        let png = place(format!("age-{age}.png"));
        grow(&["--age", &age, "--png", &png])?;
        keep(format!("age {age}"), png)?;
    }
    let whole = ["--png", &place("whole.png".into()), "-o", &place("tree.glb".into())];
    grow(&[&whole[..], &["--lods", &LEVELS.to_string()]].concat())?;
    for level in 1..=LEVELS {
        let (glb, png) = (place(format!("tree-lod{level}.glb")), place(format!("level-{level}.png")));
        let convert = ["convert", &glb, "-o", &place("other.stl".into()), "--png", &png];
        command(burgeon, &[&convert[..], &drawn].concat())?;
        keep(format!("level {level}"), png)?;
    }
    Ok(made)
}

/// Returns the default age of a species.
fn years(burgeon: &Path, key: &str) -> Outcome<f64> {
    let text = output(prepare(burgeon, &["presets", "--show", key]))?;
    let line = text.lines().find_map(|l| l.strip_prefix("years = "));
    line.and_then(|l| l.split_whitespace().next()?.parse().ok()).ok_or_else(|| format!("{key} has no years"))
}

/// Puts a picture over the background, with a word in its corner.
fn labelled(picture: &Pixels, label: &str) -> Vec<[u8; 3]> {
    let over = |c: u8, a: u8| {
        let mixed = u16::from(c) * u16::from(a) + u16::from(PAPER) * (255 - u16::from(a));
        u8::try_from(mixed / 255).unwrap_or(u8::MAX)
    };
    let mut page: Vec<[u8; 3]> =
        picture.rgba.iter().map(|&[r, g, b, a]| [over(r, a), over(g, a), over(b, a)]).collect();
    for (k, c) in label.chars().enumerate() {
        let dots = LETTERS.iter().find(|(letter, _)| *letter == c).map_or(0, |(_, dots)| *dots);
        for i in (0..15).filter(|i| dots >> (14 - i) & 1 == 1) {
            for n in 0..DOT * DOT {
                let x = DOT * (2 + 4 * k + i % 3) + n % DOT;
                let y = DOT * (2 + i / 3) + n / DOT;
                if let Some(pixel) = page.get_mut(y * picture.width + x) {
                    *pixel = [0; 3];
                }
            }
        }
    }
    page
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_label_is_dots_on_paper() {
        let blank = Pixels { rgba: vec![[0; 4]; SIDE * SIDE], width: SIDE, height: SIDE };
        let page = labelled(&blank, "1 -");
        let dark: Vec<usize> = (0..page.len()).filter(|i| page[*i] == [0; 3]).collect();
        // Eight dots of a one and three of a dash.
        assert_eq!(dark.len(), 11 * DOT * DOT);
        assert!(page.iter().all(|p| [[0; 3], [PAPER; 3]].contains(p)));
    }
}
