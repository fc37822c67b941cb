//! Free-form deformation, growth laws, surfaces. `bench/peers_bloom.py` times `NumPy`, scipy, geomdl and splipy.
//!
//! `cargo bench -p burgeon-bench --bench bloom`
#![expect(clippy::expect_used, reason = "a benchmark of sound input")]

use burgeon::Run;
use burgeon::bloom::{Lattice, Logistic, Obb, Offset, Weights, fit_law, fit_logistic, preset};
use burgeon::glam::DVec3;
use burgeon_bench::TwoThreads;
use divan::{Bencher, black_box};

fn main() {
    divan::main();
}

/// Returns points in a box of petal shape, spread by a fixed rule.
fn points(n: usize) -> Vec<DVec3> {
    (0..n)
        .map(|i| {
            let part = |k: usize| ((i * k) % 10_007) as f64 / 10_007.0;
            DVec3::new(0.06 * part(7919), 0.03 * part(6101), 0.004 * part(3571))
        })
        .collect()
}

#[divan::bench(args = [2, 3, 4, 5, 6, 8])]
fn deform_200_000(bencher: Bencher<'_, '_>, count: usize) {
    deform(bencher, count, &Run::plain());
}

#[divan::bench(args = [2, 3, 4, 5, 6, 8])]
fn deform_200_000_on_two_threads(bencher: Bencher<'_, '_>, count: usize) {
    deform(bencher, count, &Run { executor: &TwoThreads, ..Run::plain() });
}

fn deform(bencher: Bencher<'_, '_>, count: usize, run: &Run<'_>) {
    let points = points(200_000);
    let obb = Obb::fit(&points, 0.05).expect("there are points");
    let counts = [count; 3];
    let weights = Weights::new(&obb, counts, &points).expect("sound counts");
    let mut lattice = Lattice::from_box(&obb, counts).expect("sound counts");
    lattice.points.iter_mut().enumerate().for_each(|(i, p)| *p += DVec3::Y * (i as f64 * 1e-5));
    let mut out = vec![DVec3::ZERO; points.len()];
    bencher.bench_local(|| {
        weights.apply_with(black_box(&lattice), &mut out, run).expect("the lattice fits");
        out[0]
    });
}

#[divan::bench]
fn weights_200_000(bencher: Bencher<'_, '_>) {
    let points = points(200_000);
    let obb = Obb::fit(&points, 0.05).expect("there are points");
    bencher.bench_local(|| Weights::new(&obb, [4, 4, 4], black_box(&points)));
}

fn series() -> (Vec<f64>, Vec<f64>) {
    let law = Logistic { k: 60.0, p0: 6.0, r: 0.4, offset: 0.0 };
    let days: Vec<f64> = (0..25).map(f64::from).collect();
    let wobble = |i: usize| 0.6 * (((i * 37) % 11) as f64 / 5.0 - 1.0);
    let values = days.iter().enumerate().map(|(i, d)| law.value(*d) + wobble(i)).collect();
    (days, values)
}

#[divan::bench]
fn logistic_25(bencher: Bencher<'_, '_>) {
    let (days, values) = series();
    bencher.bench_local(|| fit_law(black_box(&days), black_box(&values), Offset::Auto));
}

#[divan::bench]
fn logistic_25_with_leave_one_out(bencher: Bencher<'_, '_>) {
    let (days, values) = series();
    bencher.bench_local(|| fit_logistic(black_box(&days), black_box(&values), Offset::Auto));
}

#[divan::bench]
fn overlap_of_a_tulip(bencher: Bencher<'_, '_>) {
    let spec = preset("tulip").expect("a preset");
    let law = burgeon::bloom::GrowthLaw::logistic("tulip", 5.0, 1.0);
    let plant = spec.make_on_day(2.0, &law, burgeon::Seed::new(1));
    bencher.bench_local(|| burgeon::bloom::part_overlap(black_box(&plant), None));
}

/// Times a blade of 10 rows of 7 marks: parameters, knots and controls of the bicubic surface through all of them.
#[divan::bench]
fn surface_through_10_by_7(bencher: Bencher<'_, '_>) {
    let marks: Vec<DVec3> = (0..70)
        .map(|k| {
            let (u, v) = (f64::from(k % 7) / 3.0 - 1.0, f64::from(k / 7) / 9.0);
            DVec3::new(0.1 * u * (1.2 - v), v, 0.05 * u * u + 0.1 * v * v)
        })
        .collect();
    bencher.bench_local(|| burgeon::geom::SplineSurface::interpolate(black_box(&marks), 7));
}
