use super::lines::steady;
use super::*;
use base::{Draw, Seed, ops};

/// Makes a leaf of 60 mm with a stalk of 40 mm, bent and folded, noise 0.2 mm, a hole and outliers.
fn cloud() -> Vec<DVec3> {
    leaf_of(4000)
}

/// Makes it with `count` points of the blade, and a sixteenth of that for the stalk.
fn leaf_of(count: usize) -> Vec<DVec3> {
    let mut s = Seed::new(11).stream(Draw::Test);
    let mut out = Vec::new();
    let shape = |x: f64, y: f64| DVec3::new(x, 0.25 * x.abs() - 6.0 * (y - 0.01) * (y - 0.01), -y);
    while out.len() < count {
        let (x, y) = (s.range(-0.02, 0.02), s.range(0.0, 0.06));
        let half = 0.018 * ops::sin(ops::PI * (y / 0.06));
        let hole = DVec2::new(x - 0.008, y - 0.03).length() < 0.004;
        if x.abs() < half && !hole {
            out.push(shape(x, y) + DVec3::Y * (0.0002 * s.normal()));
        }
    }
    for _ in 0..count / 16 {
        let (t, a) = (s.range(0.0, 0.04), s.range(0.0, ops::PI));
        out.push(DVec3::new(0.001 * ops::cos(a), 0.3 * t + 0.001 * ops::sin(a), t));
    }
    out.extend([DVec3::new(0.3, 0.2, 0.1), DVec3::new(-0.2, 0.3, 0.0), DVec3::NAN]);
    out
}

#[test]
fn a_made_leaf_is_found_to_its_noise() {
    let mut report = Report::default();
    let leaf = fit_scan(&cloud(), &ScanSpec::default(), &Run::plain(), &mut report).unwrap();
    assert!((2..=12).contains(&leaf.outliers), "{}", leaf.outliers);
    let n = leaf.distances.len() as f64;
    let rms = (leaf.distances.iter().map(|d| d * d).sum::<f64>() / n).sqrt();
    assert!(rms < 0.0005, "{rms}");
    assert!(leaf.explained > 0.98 && leaf.covered > 0.95, "{} {}", leaf.explained, leaf.covered);
    assert!(leaf.stalk.is_some());
    // The midrib lies in the valley x = 0 and runs from the stalk (z = 0) to the tip (z = -0.06).
    let midrib = leaf.midrib();
    let worst = midrib.iter().map(|p| p.x.abs()).fold(0.0, f64::max);
    assert!(worst < 0.0025, "{worst}");
    assert!(midrib[0].z > -0.01 && midrib[midrib.len() - 1].z < -0.055);
    let full = leaf.marks.complete(&mut Report::default()).unwrap();
    // The arc is 63 mm long; a few millimetres of its narrow ends are taken for stalk.
    let length = geom::polyline_length3(&full.midrib());
    assert!(length > 0.048 && length < 0.068, "{length}");
}

fn found(cloud: &[DVec3]) -> ScanLeaf {
    fit_scan(cloud, &ScanSpec::default(), &Run::plain(), &mut Report::default()).unwrap()
}

fn length(leaf: &ScanLeaf) -> f64 {
    geom::polyline_length3(&leaf.midrib())
}

#[test]
fn a_dense_cloud_is_no_other_leaf_than_a_half_and_a_quarter_of_it() {
    let all = leaf_of(24_000);
    let whole = found(&all);
    assert!(whole.explained > 0.98 && whole.covered > 0.95, "{} {}", whole.explained, whole.covered);
    for step in [2, 4] {
        let few: Vec<DVec3> = all.iter().copied().step_by(step).collect();
        let part = found(&few);
        assert!((length(&part) - length(&whole)).abs() < 0.002, "{} {}", length(&part), length(&whole));
        assert!((part.explained - whole.explained).abs() < 0.01, "{}", part.explained);
    }
}

#[test]
fn a_midrib_does_not_run_into_a_corner_of_the_base() {
    let mut line = vec![9.0, 4.0, 0.5, 0.0, 0.0, 0.25, -7.0];
    steady(&mut line, 0.5);
    assert_eq!(line, [1.5, 1.0, 0.5, 0.0, 0.0, 0.25, -0.25]);
    // A blade as wide as long whose base is a slanting edge: the lowest station is its corner.
    let blade: Vec<DVec3> = (0..6400)
        .map(|k| (f64::from(k % 80) / 80.0 - 0.5, f64::from(k / 80) / 80.0))
        .filter(|(x, y)| *y > 0.1 * (x + 0.5) && *y < 1.0 - 2.0 * x * x)
        .map(|(x, y)| DVec3::new(0.03 * x, 0.0, -0.06 * y))
        .collect();
    let leaf = found(&blade);
    assert!(length(&leaf) < 1.12 * leaf.midrib()[0].distance(leaf.midrib()[63]), "{}", length(&leaf));
    assert!((length(&leaf) - 0.06).abs() < 0.006, "{}", length(&leaf));
}

#[test]
fn repeated_points_a_crowd_and_far_strays_change_no_leaf() {
    let plain = found(&cloud());
    let with = |more: &mut dyn Iterator<Item = DVec3>| {
        let mut all = cloud();
        all.extend(more);
        found(&all)
    };
    let here = cloud()[10];
    let repeated = with(&mut (0..150_000).map(|_| here));
    let mut s = Seed::new(3).stream(Draw::Test);
    // Seven of eight points on a hundredth of the blade.
    let (u, v) = (DVec3::new(1.0, 0.25, 0.0), DVec3::new(0.0, -0.24, -1.0));
    let middle = DVec3::new(0.004, 0.001 - 0.0024, -0.03);
    let crowd =
        with(&mut (0..30_000).map(|_| middle + u * s.range(-0.002, 0.002) + v * s.range(-0.002, 0.002)));
    let strays = with(&mut (1..4).map(|k| DVec3::splat(-9e4 * f64::from(k))));
    for (what, leaf) in [("repeated", repeated), ("crowd", crowd), ("strays", strays)] {
        assert!((length(&leaf) - length(&plain)).abs() < 0.004, "{what}: {}", length(&leaf));
        assert!(leaf.covered > 0.93 && leaf.outliers < 100, "{what}: {} {}", leaf.covered, leaf.outliers);
    }
}

#[test]
fn a_round_leaf_lies_along_its_midrib_however_dense_it_is() {
    // As wide as long, two sides alike, a broad base: the longest direction of its points is random.
    let mut s = Seed::new(8).stream(Draw::Test);
    let way = DVec2::new(0.6, 0.8);
    let mut all = Vec::new();
    while all.len() < 6000 {
        let (x, y) = (s.range(-0.025, 0.025), s.range(0.0, 0.05));
        let v = y / 0.05;
        if x.abs() < 0.0335 * ops::powf(v, 0.35) * (1.0 - v) * (1.0 + v) {
            let flat = way * y + way.perp() * x;
            all.push(DVec3::new(flat.x, 0.2 * x.abs() + 0.0001 * s.normal(), flat.y));
        }
    }
    for step in [1, 2, 4] {
        let few: Vec<DVec3> = all.iter().copied().step_by(step).collect();
        let midrib = found(&few).midrib();
        let chord = (midrib[midrib.len() - 1] - midrib[0]).normalize();
        let along = DVec2::new(chord.x, chord.z).dot(way);
        assert!(along > 0.96, "{step}: {along}");
    }
}

#[test]
fn clouds_that_are_no_leaf_are_refused() {
    let fit = |p: &[DVec3]| fit_scan(p, &ScanSpec::default(), &Run::plain(), &mut Report::default());
    assert!(matches!(fit(&[]), Err(ScanError::TooFew(0))));
    assert!(matches!(fit(&[DVec3::NAN; 500]), Err(ScanError::TooFew(0))));
    assert!(fit(&[DVec3::ONE; 500]).is_err());
    let line: Vec<DVec3> = (0..500).map(|k| DVec3::X * (0.001 * f64::from(k))).collect();
    assert!(fit(&line).is_err());
    assert!(fit(&vec![DVec3::ONE; 200_000]).is_err());
}
