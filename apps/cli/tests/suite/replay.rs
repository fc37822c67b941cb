//! `burgeon replay` as other programs call it: a record replayed, its film, and bad input.
#![expect(clippy::unwrap_used, reason = "tests")]

use crate::tools;
use std::fmt::Write as _;
use std::fs;

use tools::{bad, folder, good, json};

/// Writes a record: a project and a hand that moves in front of its plant for `steps` steps, a fifth of a second apart.
pub(crate) fn record(steps: u32) -> String {
    let project = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/projects/version-6.burgeon");
    let mut text = format!(
        r#"{{"schema":"burgeon.gestures/1","project":"{}","steps":[{{"did":"seen"}}"#,
        base64(&fs::read(project).unwrap())
    );
    for k in 0..steps {
        // Every third step nothing moves.
        let x = 0.02 * f64::from(k - k % 3);
        write!(
            text,
            r#",{{"ms":{},"did":{{"hand":{{"tool":"rotate","reach":{{"metres":0.01,"per_metre":0,"bearers":0}},"input":{{"move":[
            {{"origin":[{x},0.1,2],"direction":[0,0,-1],"forward":[0,0,-1],"up":[0,1,0],"pressure":1,"tip":[{x},0.1,0.4]}}]}}}}}}}}"#,
            200 * (k + 1)
        )
        .unwrap();
    }
    text + "]}"
}

fn base64(bytes: &[u8]) -> String {
    const SIGNS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::new();
    for three in bytes.chunks(3) {
        let of = |k: usize| u32::from(three.get(k).copied().unwrap_or(0));
        let all = of(0) << 16 | of(1) << 8 | of(2);
        for k in 0..4 {
            let sign = char::from(SIGNS[(all >> (18 - 6 * k) & 63) as usize]);
            text.push(if k > three.len() { '=' } else { sign });
        }
    }
    text
}

/// Returns width, height and duration in hundredths of a second of the pictures of a film.
fn pictures(film: &[u8]) -> Vec<(u16, u16, u16)> {
    let word = |at: usize| u16::from_le_bytes([film[at], film[at + 1]]);
    assert_eq!((&film[..6], film.last()), (&b"GIF89a"[..], Some(&0x3b)), "a whole film");
    let skip = |mut at: usize| {
        while film[at] != 0 {
            at += 1 + usize::from(film[at]);
        }
        at + 1
    };
    let mut at = 13 + 3 * (2 << (film[10] & 7));
    let (mut delay, mut found) = (0, Vec::new());
    while film[at] != 0x3b {
        if film[at] == 0x21 {
            if film[at + 1] == 0xf9 {
                delay = word(at + 4);
            }
            at = skip(at + 2);
        } else {
            assert_eq!((film[at], film[at + 9] & 0x80), (0x2c, 0), "a picture in the palette of all");
            found.push((word(at + 5), word(at + 7), delay));
            at = skip(at + 11);
        }
    }
    found
}

#[test]
fn a_film_shows_what_moves_and_nothing_twice() {
    let f = folder("replay-film");
    fs::write(f.join("hands.json"), record(12)).unwrap();
    good(&f, &["replay", "hands.json", "--film", "hands.gif", "--size", "96x80", "--report", "told.json"]);
    let (told, film) = (json(&f.join("told.json")), fs::read(f.join("hands.gif")).unwrap());
    let all = pictures(&film);
    assert_eq!(told["frames"], 14, "the first, one a step, the last");
    assert_eq!((all[0].0, all[0].1), (96, 80));
    // Four places of the hand, and the end without it.
    assert!(all.len() == 6 || all.len() == 5, "{all:?}");
    let less = |p: &(u16, u16, u16)| u32::from(p.0) * u32::from(p.1) < 96 * 80 / 2 && p.2 == 36;
    assert!(all[1..all.len() - 1].iter().all(less), "only what differs: {all:?}");
    assert_eq!(all.last().unwrap().2, 200);
}

#[test]
fn a_record_that_is_none_is_refused() {
    let f = folder("replay-bad");
    fs::write(f.join("cut.json"), &record(3)[..300]).unwrap();
    fs::write(f.join("empty.json"), r#"{"schema":"burgeon.gestures/1","steps":[]}"#).unwrap();
    assert!(bad(&f, &["replay", "cut.json"]).contains("cut.json"));
    assert!(bad(&f, &["replay", "missing.json"]).contains("missing.json"));
    assert!(bad(&f, &["replay", "empty.json", "--film", "a.gif"]).contains("nothing to be seen"));
    assert!(bad(&f, &["replay", "empty.json", "--film", "a.mp4"]).contains("GIF"));
    assert!(!f.join("a.gif").exists());
}
