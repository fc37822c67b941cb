//! Temporary.
use super::tests::*;
use super::*;
use std::fmt::Write;
fn put(name: &str, m: &Made) {
    let mut s = String::from("{\"axes\":[");
    for (i, a) in m.plant.axes.iter().enumerate() {
        if i > 0 { s.push(','); }
        write!(s, "{{\"k\":\"{:?}\",\"o\":{},\"d\":{},\"p\":[", a.kind, a.order, i < m.drawn).unwrap();
        for (j, p) in m.plant.axis_points(AxisId::new(i)).iter().enumerate() {
            if j > 0 { s.push(','); }
            write!(s, "[{:.4},{:.4},{:.4}]", p.x, p.y, p.z).unwrap();
        }
        s.push_str("]}");
    }
    s.push_str("],\"leaves\":[");
    for (i, o) in m.plant.organs.iter().enumerate() {
        if i > 0 { s.push(','); }
        let Shape::Blade(b) = &m.plant.shapes[o.shape.index()] else { continue };
        s.push('[');
        for (j, p) in b.outline.iter().enumerate() {
            if j > 0 { s.push(','); }
            let p = o.frame.place(p.extend(0.0), o.scale);
            write!(s, "[{:.3},{:.3},{:.3}]", p.x, p.y, p.z).unwrap();
        }
        s.push(']');
    }
    s.push_str("],\"outline\":[");
    for (j, p) in m.outlines[0].iter().enumerate() {
        if j > 0 { s.push(','); }
        write!(s, "[{:.4},{:.4}]", p.x, p.y).unwrap();
    }
    s.push_str("]}");
    std::fs::write(format!("/tmp/fillout/{name}.json"), s).unwrap();
    println!("{name}: axes {} leaves {} faults {:?} warnings {:?}", m.plant.axes.len(), m.plant.organs.len(), m.plant.validate().next(), m.report.warnings);
}
#[test]
fn look() {
    std::fs::create_dir_all("/tmp/fillout").unwrap();
    let spec = SketchSpec::default();
    for name in ["round", "flat", "tall", "lobed", "cone", "concave", "bush"] {
        let t = std::time::Instant::now();
        let m = tree(name, &spec);
        println!("{:.2} ms", t.elapsed().as_secs_f64() * 1e3);
        put(name, &m);
    }
    let ring = |rx: f64, ry: f64, tilt: f64| -> Vec<DVec2> {
        (0..60).map(|i| { let (s, c) = base::ops::sin_cos(base::ops::TAU * f64::from(i) / 60.0); DVec2::new(0.6 + rx * c, 0.7 + ry * s + tilt * c) }).collect()
    };
    let lines = [line((0.5, 0.0), (0.5, 0.9), 60), line((0.5, 0.4), (0.9, 0.85), 40)];
    for (kind, n) in [(RegionKind::Twigs, "twigs"), (RegionKind::Leaves, "leaves")] {
        let t = std::time::Instant::now();
        let m = grown(ring(0.35, 0.2, 0.1), kind, &lines, &spec);
        println!("{:.2} ms", t.elapsed().as_secs_f64() * 1e3);
        put(n, &m);
    }
}
