//! `cargo xtask species`: grows every preset and writes the table of docs/trees.md, the pictures of that page and of
//! docs/shaping.md, and the small ones that the Studio shows. `cargo xtask species pine fig` does so for the rows and
//! pictures of two.

use std::fmt::Write as _;
use std::fs::File;
use std::path::Path;

use serde_json::Value;

use crate::pixels::{Pixels, length, rgba};
use xtask::shell::{Outcome, built_burgeon, command, repository, say};

const FROM: &str = "<!-- species: written by cargo xtask species -->\n";
const TO: &str = "<!-- end of species -->\n";
/// Colours of a small picture, one of them transparent: 4 bits for each pixel, so that each stays below 15 kB.
const FEW: usize = 16;
/// Colours of a picture of the page: enough for a sky.
const MANY: usize = 96;

pub(crate) fn run(only: &[String]) -> Outcome {
    let burgeon = built_burgeon()?;
    let root = repository();
    let small = root.join("apps/studio-web/public/presets");
    std::fs::create_dir_all(&small).map_err(|e| format!("cannot make {}: {e}", small.display()))?;
    let list = std::process::Command::new(&burgeon).args(["presets", "--json"]).output();
    let list = list.map_err(|e| format!("cannot run {}: {e}", burgeon.display()))?;
    let list: Value = serde_json::from_slice(&list.stdout).map_err(|e| e.to_string())?;
    let page = root.join("docs/trees.md");
    let text = std::fs::read_to_string(&page).map_err(|e| format!("cannot read {}: {e}", page.display()))?;
    let (before, rest) = text.split_once(FROM).ok_or("docs/trees.md has lost the mark before its table")?;
    let (old, after) = rest.split_once(TO).ok_or("docs/trees.md has lost the mark after its table")?;
    let mut table = String::from(
        "| picture | species | growth | branches | leaves | triangles |\n\
         |---|---|---|---|---|---|\n",
    );
    for row in list.as_array().into_iter().flatten() {
        let word = |key: &str| row[key].as_str().unwrap_or_default();
        let key = word("preset");
        // Those are made by `cargo xtask flowers`.
        if word("method") == "flower" {
            continue;
        }
        let kept = old.lines().find(|line| line.contains(&format!("**`{key}`**")));
        if let Some(row) = kept.filter(|_| !only.is_empty() && only.iter().all(|o| o != key)) {
            let _ = writeln!(table, "{row}");
            continue;
        }
        let picture = root.join(format!("docs/pictures/trees/{key}.png"));
        let item = grown(&burgeon, key, &picture, &["--size", "400x400"])?;
        shrink(&picture, MANY)?;
        let thumbnail = small.join(format!("{key}.png"));
        grown(
            &burgeon,
            key,
            &thumbnail,
            &["--size", "256x256", "--background", "transparent", "--no-shadow"],
        )?;
        shrink(&thumbnail, FEW)?;
        let (counts, growth) = (&item["counts"], &item["growth"]);
        let n = |v: &Value, key: &str| grouped(v[key].as_u64().unwrap_or_default());
        let points = match growth["attractors"].as_u64().unwrap_or_default() {
            0 => String::new(),
            _ => format!(", {} of {} points", n(growth, "consumed"), n(growth, "attractors")),
        };
        let flowers = match counts["flowers"].as_u64().unwrap_or_default() {
            0 => String::new(),
            _ => format!(" and {} flowers", n(counts, "flowers")),
        };
        let _ = writeln!(
            table,
            "| <img src=\"pictures/trees/{key}.png\" width=\"200\"> | **`{key}`** *{}*: {} | {}{points} | {} | {}{flowers} \
             | {} |",
            word("species"),
            word("about"),
            word("method"),
            n(counts, "branches"),
            n(counts, "leaves"),
            n(counts, "triangles"),
        );
    }
    std::fs::write(&page, format!("{before}{FROM}{table}{TO}{after}"))
        .map_err(|e| format!("cannot write {}: {e}", page.display()))?;
    if !only.is_empty() {
        return Ok(());
    }
    crate::scenes::make()?;
    say("docs/trees.md, its pictures, those of docs/shaping.md and those of the Studio are made anew");
    Ok(())
}

/// Grows a preset and draws it; returns its entry of the report.
fn grown(burgeon: &Path, key: &str, picture: &Path, more: &[&str]) -> Result<Value, String> {
    let report = std::env::temp_dir().join(format!("burgeon-species-{}.json", std::process::id()));
    let (png, json) = (picture.display().to_string(), report.display().to_string());
    let args = ["grow", key, "--png", &png, "--report", &json, "--quiet"];
    command(burgeon, &[&args, more].concat())?;
    let text = std::fs::read_to_string(&report).map_err(|e| format!("cannot read {json}: {e}"))?;
    let _ = std::fs::remove_file(&report);
    let mut whole: Value = serde_json::from_str(&text).map_err(|e| format!("{json}: {e}"))?;
    Ok(whole["items"][0].take())
}

fn grouped(n: u64) -> String {
    let digits = n.to_string();
    let mut out = String::new();
    for (i, d) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            out.push(',');
        }
        out.push(d);
    }
    out
}

/// Rewrites a picture with 16 colours, 4 bits for each pixel, or up to 256, 8 bits; one of them is transparent.
fn shrink(path: &Path, colours: usize) -> Outcome {
    let fault = |e: &dyn std::fmt::Display| format!("{}: {e}", path.display());
    let Pixels { rgba: pixels, width, height } = rgba(path)?;
    let seen: Vec<[u8; 3]> = pixels.iter().filter(|p| p[3] >= 128).map(|p| [p[0], p[1], p[2]]).collect();
    let palette = median_cut(seen, colours - 1);
    let nearest = |p: &[u8; 4]| -> u8 {
        let far = |c: &[u8; 3]| (0..3).map(|i| (i32::from(c[i]) - i32::from(p[i])).pow(2)).sum::<i32>();
        let best = (0_u8..).zip(&palette).min_by_key(|(_, c)| far(c)).map_or(0, |(k, _)| k);
        if p[3] < 128 { 0 } else { best + 1 }
    };
    let indices: Vec<u8> = pixels.iter().map(nearest).collect();
    let four = colours <= FEW;
    let packed: Vec<u8> = if four {
        let rows = indices.chunks(width);
        rows.flat_map(|row| row.chunks(2).map(|p| p[0] << 4 | p.get(1).copied().unwrap_or(0))).collect()
    } else {
        indices
    };
    let out = File::create(path).map_err(|e| fault(&e))?;
    let mut encoder = png::Encoder::new(std::io::BufWriter::new(out), length(width), length(height));
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_depth(if four { png::BitDepth::Four } else { png::BitDepth::Eight });
    encoder.set_palette([&[0; 3][..], palette.as_flattened()].concat());
    encoder.set_trns(vec![0]);
    encoder.set_compression(png::Compression::High);
    encoder.set_filter(png::Filter::NoFilter);
    let mut writer = encoder.write_header().map_err(|e| fault(&e))?;
    writer.write_image_data(&packed).map_err(|e| fault(&e))?;
    writer.finish().map_err(|e| fault(&e))
}

/// Returns colours that represent all of `seen`: a box of colours is halved at its median until there are `count` boxes
/// (Heckbert 1982); each gives its mean. The next box is the one with the largest product of its pixels and its longest
/// side squared, so that a wide sky has many.
fn median_cut(seen: Vec<[u8; 3]>, count: usize) -> Vec<[u8; 3]> {
    let mut boxes = vec![seen];
    let side = |colours: &[[u8; 3]], i: usize| {
        let of = colours.iter().map(|c| c[i]);
        of.clone().max().unwrap_or(0) - of.min().unwrap_or(0)
    };
    while boxes.len() < count {
        let sides = (0..boxes.len()).flat_map(|b| (0..3).map(move |i| (b, i)));
        let much = |(b, i): (usize, usize)| boxes[b].len() * usize::from(side(&boxes[b], i)).pow(2);
        let Some((b, i)) = sides.max_by_key(|&at| much(at)) else { break };
        if side(&boxes[b], i) == 0 {
            break;
        }
        let mut low = boxes.swap_remove(b);
        low.sort_unstable_by_key(|c| c[i]);
        let mut at = low.len() / 2;
        // Equal colours stay together, and neither half is empty.
        while at > 0 && low[at - 1][i] == low[at][i] {
            at -= 1;
        }
        if at == 0 {
            at = low.partition_point(|c| c[i] == low[0][i]);
        }
        let high = low.split_off(at);
        boxes.extend([low, high]);
    }
    let mean = |colours: &Vec<[u8; 3]>| {
        let n = colours.len().max(1);
        [0, 1, 2].map(|i| {
            u8::try_from(colours.iter().map(|c| usize::from(c[i])).sum::<usize>() / n).unwrap_or(255)
        })
    };
    boxes.iter().map(mean).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_colours_are_kept_as_they_are() {
        let seen = vec![[0, 0, 0], [0, 0, 0], [250, 10, 10], [10, 250, 10], [0, 0, 0]];
        let mut palette = median_cut(seen, 15);
        palette.sort_unstable();
        assert_eq!(palette, [[0, 0, 0], [10, 250, 10], [250, 10, 10]]);
        assert_eq!(median_cut((0..=255).map(|g| [g, g, 0]).collect(), 15).len(), 15);
        assert_eq!(grouped(1_234_567), "1,234,567");
    }
}
