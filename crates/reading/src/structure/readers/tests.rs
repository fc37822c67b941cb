use base::ops;
use glam::DVec2;
use ink::{Drawing, Ink, StrokeClass};

use super::{Proposal, propose};
use crate::Kind;

fn p(x: f64, y: f64) -> DVec2 {
    DVec2::new(x, y)
}

fn seen(lines: &[Vec<DVec2>]) -> Vec<Proposal> {
    propose(&cleaned(lines))
}

fn cleaned(lines: &[Vec<DVec2>]) -> Ink {
    ink::clean(&Drawing::from_polylines("test", lines), &mut base::Report::default())
}

/// A quadratic curve from `a` to `b` that leans to `c`.
fn arc(a: DVec2, c: DVec2, b: DVec2) -> Vec<DVec2> {
    let at = |k: u8| {
        let t = f64::from(k) / 24.0;
        a * ((1.0 - t) * (1.0 - t)) + c * (2.0 * t * (1.0 - t)) + b * (t * t)
    };
    (0..=24).map(at).collect()
}

/// A leaf from its root to its tip, as one line.
fn leaf(root: DVec2, tip: DVec2, wide: f64) -> Vec<DVec2> {
    let side = (tip - root).perp() * wide;
    let mut line = arc(root, root.midpoint(tip) + side, tip);
    line.extend(arc(tip, root.midpoint(tip) - side, root));
    line
}

fn ring(centre: DVec2, radius: f64) -> Vec<DVec2> {
    (0..=48)
        .map(|k| ops::sin_cos(ops::TAU * f64::from(k) / 48.0))
        .map(|(s, c)| centre + p(c, s) * radius)
        .collect()
}

fn first(lines: &[Vec<DVec2>]) -> Option<Kind> {
    seen(lines).first().map(|p| p.kind)
}

#[test]
fn an_outline_with_a_midrib_that_leaves_it_as_petiole_is_a_leaf() {
    let lines = [leaf(p(0.0, 0.0), p(6.0, 6.0), 0.5), vec![p(-1.5, -1.5), p(0.0, 0.0), p(3.5, 3.5)]];
    assert_eq!(first(&lines), Some(Kind::Leaf));
    // Without the line it may be any pointed shape.
    assert_eq!(first(&lines[..1]), None);
    // A stalk on a round outline is an apple's.
    assert_eq!(first(&[ring(p(0.0, 0.0), 3.0), vec![p(0.0, 3.0), p(0.4, 4.2)]]), None);
}

#[test]
fn two_leaves_on_a_stem_are_a_sprig_and_two_crowns_are_not() {
    let stem = vec![p(0.0, 0.0), p(0.0, 5.0)];
    let leaves = [leaf(p(0.0, 5.0), p(4.0, 8.0), 0.5), leaf(p(0.0, 5.0), p(-4.0, 8.0), 0.5)];
    assert_eq!(first(&[stem.clone(), leaves[0].clone(), leaves[1].clone()]), Some(Kind::Stem));
    let crowns = [ring(p(2.5, 7.0), 2.0), ring(p(-2.5, 7.0), 2.0)];
    let limbs = [vec![p(0.0, 5.0), p(1.2, 5.4)], vec![p(0.0, 5.0), p(-1.2, 5.4)]];
    let [a, b] = limbs;
    let [c, d] = crowns;
    assert_eq!(first(&[stem, a, b, c, d]), None);
}

#[test]
fn four_hearts_that_meet_are_a_clover_and_four_ovals_are_a_flower_only_round_a_disc() {
    let turned = |line: &[DVec2], way: DVec2| line.iter().map(|q| way.rotate(*q)).collect::<Vec<_>>();
    let mut heart = arc(p(0.0, 0.0), p(1.2, 3.4), p(1.2, 3.8));
    heart.extend(arc(p(1.2, 3.8), p(0.6, 5.0), p(0.0, 3.9)));
    heart.extend(arc(p(0.0, 3.9), p(-0.6, 5.0), p(-1.2, 3.8)));
    heart.extend(arc(p(-1.2, 3.8), p(-1.2, 3.4), p(0.0, 0.0)));
    let ways = [DVec2::X, DVec2::Y, DVec2::NEG_X, DVec2::NEG_Y];
    let hearts: Vec<Vec<DVec2>> = ways.iter().map(|w| turned(&heart, *w)).collect();
    let found = seen(&hearts);
    assert_eq!(found.first().map(|p| (p.kind, p.parts.len())), Some((Kind::Leaf, 4)));

    let petal: Vec<DVec2> = leaf(p(0.0, 1.0), p(0.0, 4.0), 0.8);
    let mut flower: Vec<Vec<DVec2>> = (0..6)
        .map(|k| ops::sin_cos(ops::TAU * f64::from(k) / 6.0))
        .map(|(s, c)| turned(&petal, p(c, s)))
        .collect();
    flower.push(ring(DVec2::ZERO, 1.0));
    assert_eq!(first(&flower), Some(Kind::Flower));
}

#[test]
fn a_pointed_crown_on_a_trunk_is_a_conifer_and_a_round_one_is_not() {
    let trunk = vec![p(0.0, 0.0), p(0.0, 2.0)];
    let crown = vec![p(-3.0, 2.0), p(0.0, 9.0), p(3.0, 2.0), p(-3.0, 2.0)];
    assert_eq!(first(&[trunk.clone(), crown]), Some(Kind::Conifer));
    assert_eq!(first(&[trunk, ring(p(0.0, 5.0), 3.0)]), None);
}

/// Three petals on a stem, seen from the side; the stem is the first line.
fn tulip() -> Vec<Vec<DVec2>> {
    let stem = vec![p(0.0, 0.0), p(0.0, 5.0)];
    let petals = [
        leaf(p(0.0, 5.0), p(0.0, 10.0), 0.45),
        arc(p(0.0, 5.0), p(3.4, 5.2), p(3.0, 9.6)),
        arc(p(3.0, 9.6), p(1.8, 9.0), p(0.95, 8.0)),
        arc(p(0.0, 5.0), p(-3.4, 5.2), p(-3.0, 9.6)),
        arc(p(-3.0, 9.6), p(-1.8, 9.0), p(-0.95, 8.0)),
    ];
    let mut lines = vec![stem];
    lines.extend(petals);
    lines
}

#[test]
fn petals_that_rise_from_a_stem_are_one_flower_seen_from_the_side() {
    let found = seen(&tulip());
    assert_eq!(
        found.first().map(|p| (p.kind, p.heads.iter().map(Vec::len).collect())),
        Some((Kind::Flower, vec![3]))
    );
}

#[test]
fn arcs_that_fan_out_from_a_trunk_of_two_sides_are_a_palm_and_scallops_are_not() {
    let trunk = [p(-0.6, 0.0), p(0.6, 0.0)].map(|foot| vec![foot, p(foot.x * 0.5, 7.0)]);
    let arcs = [
        arc(p(0.0, 7.0), p(2.5, 8.5), p(4.5, 6.0)),
        arc(p(0.0, 7.0), p(-2.5, 8.5), p(-4.5, 6.0)),
        arc(p(0.0, 7.0), p(0.5, 10.0), p(2.5, 10.5)),
    ];
    let frond = leaf(p(0.0, 7.0), p(-3.0, 10.0), 0.25);
    let mut lines = trunk.to_vec();
    lines.extend(arcs);
    lines.push(frond.clone());
    let found = seen(&lines);
    assert_eq!(found.first().map(|p| (p.kind, p.parts.len())), Some((Kind::Palm, 6)));
    let scallops = |x: f64| {
        let bay = |k: f64| arc(p(x * k, 7.0), p(x * (k + 0.5), 9.0), p(x * (k + 1.0), 7.0));
        [0.0, 1.0, 2.0].map(bay).concat()
    };
    let mut lines = trunk.to_vec();
    lines.extend([scallops(1.5), scallops(-1.5), frond]);
    assert_ne!(first(&lines), Some(Kind::Palm));
}

#[test]
fn a_body_that_tapers_away_from_its_leaves_is_a_root_and_one_with_spines_is_not() {
    let body = [p(-1.6, 6.0), p(-1.2, 7.0), p(0.0, 7.3), p(1.2, 7.0), p(1.6, 6.0), p(0.0, 0.0), p(-1.6, 6.0)];
    let leaves = [p(-1.2, 9.0), p(0.0, 9.4), p(1.2, 9.0)].map(|tip| vec![p(tip.x * 0.2, 7.3), tip]);
    let mut lines = vec![body.to_vec()];
    lines.extend(leaves);
    assert_eq!(first(&lines), Some(Kind::Vegetable));
    let spines = [p(-1.5, 6.0), p(1.2, 5.0), p(-0.8, 3.0)].map(|foot| vec![foot, foot + p(foot.x, 0.3)]);
    let mut lines = vec![body.to_vec()];
    lines.extend(spines);
    assert_eq!(first(&lines), None);
    // With the tip upwards it is a bud, or a flame.
    let upside_down = |line: &Vec<DVec2>| line.iter().map(|q| p(q.x, -q.y)).collect::<Vec<_>>();
    let turned: Vec<Vec<DVec2>> = lines.iter().map(upside_down).collect();
    assert_eq!(first(&turned), None);
}

#[test]
fn a_round_head_over_leaves_on_a_stem_is_a_flower_and_one_without_leaves_may_be_a_tree() {
    let stem = vec![p(0.0, 0.0), p(0.0, 6.0)];
    let (head, heart) = (ring(p(0.0, 8.5), 2.5), ring(p(0.4, 8.8), 1.0));
    let whorl = arc(p(-0.6, 8.8), p(-1.0, 10.6), p(1.4, 10.5));
    let leaf = leaf(p(0.0, 2.0), p(2.6, 3.8), 0.5);
    let rose = [stem, head, heart, whorl, leaf];
    assert_eq!(first(&rose), Some(Kind::Flower));
    assert_eq!(first(&rose[..2]), None);
}

#[test]
fn grains_in_pairs_along_a_stem_begin_on_it_with_their_lower_corner() {
    let mut lines = vec![vec![p(0.0, 0.0), p(0.0, 8.0)]];
    for k in 0..4 {
        let base = p(0.0, 2.0 + 1.6 * f64::from(k));
        lines.extend([2.0, -2.0].map(|x| leaf(base, base + p(x * 0.6, 2.0), 0.5)));
    }
    let found = seen(&lines);
    let ear = found.first().expect("an ear");
    assert_eq!((ear.kind, ear.parts.iter().filter(|p| p.root.is_some()).count()), (Kind::Stem, 8));
    // In ink units, as the roots are.
    let ink = cleaned(&lines);
    let stem = ink.strokes[0].points[0].x;
    assert!(ear.parts.iter().filter_map(|p| p.root).all(|root| (root.x - stem).abs() < 0.01));
}

#[test]
fn what_encloses_nothing_or_has_no_extent_gives_no_proposal() {
    assert!(seen(&[]).is_empty());
    assert!(seen(&[vec![DVec2::ZERO, DVec2::ZERO]]).is_empty());
    assert!(seen(&[vec![p(0.0, 0.0), p(0.0, 9.0)], vec![p(0.0, 4.0), p(3.0, 7.0)]]).is_empty());
}

#[test]
fn half_a_ball_on_a_narrow_stem_is_a_mushroom_and_a_round_crown_is_not() {
    let dome = |high: f64| {
        let mut cap: Vec<DVec2> = (0..=24)
            .map(|k| ops::sin_cos(0.5 * ops::TAU * f64::from(k) / 24.0))
            .map(|(s, c)| p(3.0 * c, 3.0 + high * s))
            .collect();
        cap.push(cap[0]);
        cap
    };
    let stem = vec![p(-0.7, 3.0), p(-0.8, 0.0), p(0.8, 0.0), p(0.7, 3.0)];
    let spot = ring(p(0.6, 4.3), 0.5);
    let mushroom = [dome(2.8), stem.clone(), spot];
    let proposals = seen(&mushroom);
    let proposal = proposals.iter().find(|p| p.word == Some("mushroom")).expect("a mushroom");
    assert_eq!((proposal.kind, proposal.parts.len()), (Kind::Vegetable, 2));
    let is_mushroom = |lines: &[Vec<DVec2>]| seen(lines).iter().any(|p| p.word.is_some());
    assert!(!is_mushroom(&[ring(p(0.0, 5.5), 2.6), stem.clone()]), "widest in its middle");
    let conifer = vec![p(-3.0, 3.0), p(0.0, 7.5), p(3.0, 3.0), p(-3.0, 3.0)];
    assert!(!is_mushroom(&[conifer, stem]), "it runs out to a point");
}

#[test]
fn a_column_with_arms_that_turn_up_is_a_cactus_and_one_with_arms_that_hang_is_not() {
    let dome = |k: u8| ops::sin_cos(0.5 * ops::TAU * f64::from(k) / 16.0);
    let mut body = vec![p(1.0, 0.0)];
    body.extend((0..=16).map(dome).map(|(s, c)| p(c, 6.0 + s)));
    body.push(p(-1.0, 0.0));
    let ground = vec![p(-2.0, 0.0), p(2.0, 0.0)];
    let arm = |end: f64| vec![p(1.0, 3.0), p(2.4, 3.0), p(2.8, end)];
    let other = vec![p(-1.0, 2.2), p(-2.2, 2.2), p(-2.6, 4.0)];
    let lines = [body.clone(), ground.clone(), arm(5.0), other.clone()];
    let proposals = seen(&lines);
    let cactus = proposals.iter().find(|p| p.kind == Kind::Cactus).expect("a cactus");
    assert_eq!((cactus.word, cactus.parts.len()), (Some("cactus"), 4));
    let is_cactus = |lines: &[Vec<DVec2>]| seen(lines).iter().any(|p| p.kind == Kind::Cactus);
    assert!(!is_cactus(&[body, ground.clone(), arm(1.0), other.clone()]), "branches hang");
    let cone = vec![p(1.0, 0.0), p(0.0, 7.0), p(-1.0, 0.0)];
    assert!(!is_cactus(&[cone, ground, arm(5.0), other]), "it has no round top");
}

#[test]
fn leaves_over_one_another_with_midribs_are_loose_leaves_and_petals_from_one_base_are_not() {
    let front = leaf(p(0.0, 0.0), p(6.0, 6.0), 0.4);
    let rib = vec![p(-0.8, -0.8), p(0.0, 0.0), p(3.5, 3.5)];
    // It goes behind the first one, on whose side both its ends lie.
    let behind = [arc(p(1.0, 3.0), p(-3.0, 4.0), p(-2.5, 9.0)), arc(p(-2.5, 9.0), p(1.0, 9.0), p(2.6, 5.2))];
    let its_rib = vec![p(0.9, 4.6), p(-1.0, 7.0)];
    let [one, two] = behind;
    let lines = [front, rib, one, two, its_rib];
    let found = seen(&lines);
    let leaves = found.iter().find(|p| p.kind == Kind::Leaf).expect("leaves");
    let blades = leaves.parts.iter().filter(|p| p.class == StrokeClass::Blade);
    assert_eq!(blades.count(), 2);
    let petals = [p(-4.0, 5.0), p(0.0, 7.0), p(4.0, 5.0)];
    let ribbed: Vec<Vec<DVec2>> =
        petals.iter().flat_map(|&tip| [leaf(DVec2::ZERO, tip, 0.3), vec![tip * 0.1, tip * 0.6]]).collect();
    assert!(!seen(&ribbed).iter().any(|p| p.kind == Kind::Leaf));
}

#[test]
fn the_narrow_face_below_a_pointed_crown_is_its_trunk() {
    let crown = vec![p(-3.0, 2.0), p(0.0, 9.0), p(3.0, 2.0), p(-3.0, 2.0)];
    let trunk = vec![p(-1.0, 2.0), p(-1.4, 0.0), p(1.4, 0.0), p(1.0, 2.0)];
    let found = seen(&[crown, trunk]);
    let conifer = found.first().expect("a conifer");
    let classes: Vec<StrokeClass> = conifer.parts.iter().map(|p| p.class).collect();
    assert_eq!(classes, [StrokeClass::Crown, StrokeClass::TrunkOutline]);
}

#[test]
fn leaves_over_a_root_may_be_drawn_in_one_outline() {
    let body =
        vec![p(-1.6, 6.0), p(-1.2, 7.0), p(0.0, 7.3), p(1.2, 7.0), p(1.6, 6.0), p(0.0, 0.0), p(-1.6, 6.0)];
    let tuft =
        [[0.3, 7.3], [1.4, 9.6], [0.5, 8.6], [0.0, 10.2], [-0.5, 8.6], [-1.4, 9.6], [-0.3, 7.3], [0.3, 7.3]];
    let tuft: Vec<DVec2> = tuft.into_iter().map(DVec2::from).collect();
    let found = seen(&[body, tuft]);
    assert_eq!(found.first().map(|p| (p.kind, p.word)), Some((Kind::Vegetable, Some("carrot"))));
}

#[test]
fn balls_packed_on_a_stalk_are_a_bunch_and_petals_round_a_disc_are_not() {
    let rows = [(4, 0.0), (3, -1.75), (2, -3.5), (1, -5.25)];
    let balls = rows.iter().flat_map(|&(count, y)| {
        (0..count).map(move |k| ring(p(2.0 * f64::from(k) - f64::from(count), y), 1.0))
    });
    let mut lines: Vec<Vec<DVec2>> = balls.collect();
    let stalk = vec![p(-1.0, 0.9), p(-0.6, 3.0)];
    lines.push(stalk);
    let found = seen(&lines);
    assert_eq!(found.first().map(|p| (p.kind, p.word)), Some((Kind::Fruit, Some("grapes"))));
    assert_eq!(found[0].parts.iter().filter(|p| p.class == StrokeClass::Fruit).count(), 10);
    let petals = (0..6).map(|k| ops::sin_cos(ops::TAU * f64::from(k) / 6.0));
    let mut flower: Vec<Vec<DVec2>> = petals.map(|(s, c)| ring(p(c, s) * 2.0, 1.0)).collect();
    flower.push(ring(DVec2::ZERO, 1.0));
    flower.push(vec![p(0.0, -3.0), p(0.0, -9.0)]);
    assert_eq!(first(&flower), Some(Kind::Flower));
}

#[test]
fn lobes_round_a_ring_on_a_stem_are_petals_also_in_a_pot() {
    let head: Vec<DVec2> = (0..=120)
        .map(|k| {
            let turn = ops::TAU * f64::from(k) / 120.0;
            let (sin, cos) = ops::sin_cos(turn);
            p(0.0, 9.0) + p(cos, sin) * (2.6 + 0.5 * ops::sin(5.0 * turn))
        })
        .collect();
    let (disc, stem) = (ring(p(0.0, 9.0), 0.7), vec![p(0.0, 6.9), p(0.0, 3.0)]);
    let free = [head.clone(), disc.clone(), vec![p(0.0, 6.9), p(0.0, 0.0)]];
    let found = seen(&free);
    assert_eq!(found.first().map(|p| (p.kind, p.heads[0].len())), Some((Kind::Flower, 5)));
    // Without the ring it is the crown of a tree.
    assert_eq!(first(&[head.clone(), stem.clone()]), None);
    let pot = vec![p(-1.8, 3.0), p(-1.2, 0.0), p(1.2, 0.0), p(1.8, 3.0), p(-1.8, 3.0)];
    let found = seen(&[head, disc, stem, pot]);
    let potted = found.first().expect("a potted flower");
    assert_eq!((potted.kind, potted.heads[0].len()), (Kind::HousePlant, 5));
    assert!(potted.parts.iter().any(|p| p.class == StrokeClass::Pot));
}

#[test]
fn a_cap_over_two_lines_on_the_ground_is_a_mushroom() {
    let mut cap: Vec<DVec2> = (0..=24)
        .map(|k| ops::sin_cos(0.5 * ops::TAU * f64::from(k) / 24.0))
        .map(|(s, c)| p(3.0 * c, 3.5 + 2.8 * s))
        .collect();
    cap.push(cap[0]);
    let sides = [-0.8, 0.8].map(|x| vec![p(x, 3.2), p(x, 0.0)]);
    let [left, right] = sides;
    let found = seen(&[cap, left, right, vec![p(-2.0, 0.0), p(2.0, 0.0)]]);
    let mushroom = found.iter().find(|p| p.word == Some("mushroom")).expect("a mushroom");
    let count = |class: StrokeClass| mushroom.parts.iter().filter(|p| p.class == class).count();
    let (bodies, ground) = (count(StrokeClass::Fruit), count(StrokeClass::Ground));
    assert_eq!((bodies, bodies + ground), (2, mushroom.parts.len()));
}

#[test]
fn a_blade_with_pointed_lobes_is_a_leaf_and_tiers_are_a_conifer() {
    let half = [
        [0.4, 2.0],
        [2.0, 1.6],
        [1.7, 2.6],
        [3.6, 3.9],
        [2.9, 4.2],
        [3.1, 5.2],
        [1.4, 4.4],
        [1.5, 6.2],
        [0.9, 5.9],
    ];
    let mirrored = half.iter().rev().map(|q| p(-q[0], q[1]));
    let mut maple: Vec<DVec2> = half.iter().map(|&q| DVec2::from(q)).collect();
    maple.push(p(0.0, 8.0));
    maple.extend(mirrored);
    maple.push(maple[0]);
    let petiole = vec![p(0.0, 0.0), p(0.0, 3.5)];
    assert_eq!(first(&[maple, petiole]), Some(Kind::Leaf));
    let tiers = [[0.0, 9.0], [1.6, 6.6], [0.8, 6.6], [2.4, 4.4], [1.4, 4.4], [3.2, 2.0]];
    let mut conifer: Vec<DVec2> = tiers.iter().map(|&q| DVec2::from(q)).collect();
    conifer.extend(tiers.iter().rev().map(|q| p(-q[0], q[1])));
    assert_eq!(first(&[conifer, vec![p(0.0, 0.0), p(0.0, 2.0)]]), Some(Kind::Conifer));
}

#[test]
fn two_lenses_are_leaves_and_two_slices_are_not() {
    let lens = |x: f64| leaf(p(x, 0.0), p(x + 3.0, 3.0), 0.5);
    assert_eq!(first(&[lens(0.0), lens(4.5)]), Some(Kind::Leaf));
    let slice = |x: f64| {
        let mut line = arc(p(x, 0.0), p(x + 3.6, -0.6), p(x + 3.0, 3.0));
        line.push(p(x, 0.0));
        line
    };
    assert_eq!(first(&[slice(0.0), slice(4.5)]), None);
}

#[test]
fn a_round_body_with_ribs_is_one_fruit() {
    let ribs = [-1.2, 1.2].map(|x| arc(p(x * 0.6, 2.5), p(x * 1.4, 0.0), p(x * 0.6, -2.5)));
    let [left, right] = ribs;
    let pumpkin = [ring(DVec2::ZERO, 3.0), left, right, vec![p(0.0, 3.0), p(0.3, 4.0)]];
    let found = seen(&pumpkin);
    let fruit = found.iter().find(|p| p.kind == Kind::Fruit).expect("a fruit");
    assert_eq!(fruit.parts.len(), 2);
}

#[test]
fn a_leaf_above_an_apple_is_a_leaf_on_a_stalk() {
    let apple = [ring(DVec2::ZERO, 3.0), leaf(p(0.3, 3.9), p(1.5, 5.2), 0.4)];
    let found = seen(&apple);
    let fruit = found.iter().find(|p| p.kind == Kind::Fruit).expect("a fruit");
    let classes: Vec<StrokeClass> = fruit.parts.iter().map(|p| p.class).collect();
    assert_eq!(classes, [StrokeClass::Fruit, StrokeClass::Blade, StrokeClass::Axis]);
    // A leaf as large as the body is none of its own.
    let seedling = [ring(DVec2::ZERO, 3.0), leaf(p(0.3, 3.9), p(6.5, 9.2), 0.5)];
    assert!(seen(&seedling).iter().all(|p| p.kind != Kind::Fruit));
}

#[test]
fn half_a_disc_with_seeds_is_a_slice() {
    let mut slice = arc(p(-3.0, 0.0), p(-3.0, -3.6), p(0.0, -3.0));
    slice.extend(arc(p(0.0, -3.0), p(3.0, -3.6), p(3.0, 0.0)));
    slice.push(p(-3.0, 0.0));
    let seeds = [-1.0, 0.0, 1.0].map(|x| vec![p(x, -1.0), p(x, -1.4)]);
    let [a, b, c] = seeds;
    assert_eq!(first(&[slice.clone(), a, b, c]), Some(Kind::Fruit));
    assert_eq!(first(&[slice]), None, "an empty one may be a bowl");
}

#[test]
fn lines_that_lead_down_from_a_trunk_are_a_conifer() {
    let chevron = |y: f64, wide: f64| vec![p(-wide, y - wide), p(0.0, y), p(wide, y - wide)];
    let trunk = vec![p(0.0, 9.0), p(0.0, 0.0)];
    let fir = [trunk.clone(), chevron(9.0, 1.5), chevron(7.0, 2.0), chevron(5.0, 2.6)];
    assert_eq!(first(&fir), Some(Kind::Conifer));
    let ear = |y: f64, wide: f64| vec![p(-wide, y + wide), p(0.0, y), p(wide, y + wide)];
    assert_eq!(first(&[trunk, ear(7.0, 1.5), ear(5.0, 1.5), ear(3.0, 1.5)]), None);
}

#[test]
fn circles_in_a_ring_are_petals_and_others_are_not() {
    let circle = |k: u8, away: f64| {
        let (s, c) = ops::sin_cos(ops::TAU * f64::from(k) / 5.0);
        ring(p(c, s) * away, 1.0)
    };
    let flower: Vec<Vec<DVec2>> = (0..5).map(|k| circle(k, 3.0)).collect();
    let found = seen(&flower);
    assert_eq!((found[0].kind, found[0].heads.len()), (Kind::Flower, 1));
    let uneven: Vec<Vec<DVec2>> = (0..5).map(|k| circle(k, 2.0 + f64::from(k))).collect();
    assert!(seen(&uneven).iter().all(|p| p.kind != Kind::Flower));
}

#[test]
fn a_crown_with_a_flat_foot_on_one_line_is_a_tree() {
    let mut cloud = arc(p(-4.0, 4.0), p(-5.5, 6.5), p(-2.5, 6.5));
    cloud.extend(arc(p(-2.5, 6.5), p(0.0, 9.5), p(2.5, 6.5)));
    cloud.extend(arc(p(2.5, 6.5), p(5.5, 6.5), p(4.0, 4.0)));
    cloud.push(p(-4.0, 4.0));
    let kinds = |lines: &[Vec<DVec2>]| seen(lines).iter().map(|p| p.kind).collect::<Vec<_>>();
    assert!(kinds(&[cloud.clone(), vec![p(0.0, 4.0), p(0.0, 0.0)]]).contains(&Kind::Tree));
    let stem = vec![p(-1.0, 4.0), p(-1.0, 0.0), p(1.0, 0.0), p(1.0, 4.0)];
    assert!(!kinds(&[cloud, stem]).contains(&Kind::Tree), "a mushroom stands on two lines");
}

#[test]
fn a_disc_in_a_circle_on_a_stem_has_rays() {
    let stem = vec![p(0.0, -3.0), p(0.0, -9.0)];
    let found =
        seen(&[ring(DVec2::ZERO, 3.0), ring(DVec2::ZERO, 1.2), stem, leaf(p(0.0, -7.0), p(3.0, -5.0), 0.3)]);
    assert_eq!(found[0].kind, Kind::Flower);
    let discs = found[0].parts.iter().filter(|p| p.class == StrokeClass::Disc).count();
    assert_eq!((discs, found[0].parts.len()), (1, 15), "twelve rays, a disc, a leaf and a stem");
}

#[test]
fn blades_that_were_painted_green_are_no_petals() {
    let mut drawing = Drawing::from_polylines("test", &tulip());
    let kinds = |drawing: &Drawing| {
        let ink = ink::clean(drawing, &mut base::Report::default());
        propose(&ink).iter().map(|p| p.kind).collect::<Vec<_>>()
    };
    for (color, kind) in [([220, 60, 120], Kind::Flower), ([30, 160, 60], Kind::Stem)] {
        drawing.strokes.iter_mut().for_each(|s| s.color = Some(color));
        drawing.strokes[0].color = Some(if kind == Kind::Flower { [30, 160, 60] } else { [120, 70, 30] });
        assert_eq!(kinds(&drawing).first(), Some(&kind));
    }
}

/// The petal in front of a rose in profile: a cup whose rim falls to the right.
fn rose_front() -> Vec<DVec2> {
    let cup = |k: u32| {
        let (s, c) = ops::sin_cos(ops::PI * f64::from(k) / 24.0);
        p(-3.0 * c, 4.0 - 4.0 * s)
    };
    (0..=24).map(cup).chain([p(3.0, 4.2), p(-3.0, 6.2), p(-3.0, 4.0)]).collect()
}

#[test]
fn petals_that_show_close_above_a_cup_are_a_rose_and_leaves_on_a_fruit_are_not() {
    let left = vec![p(-2.9, 6.6), p(-0.6, 5.8), p(-1.0, 7.6), p(-2.6, 7.8), p(-2.9, 6.6)];
    let right = vec![p(-0.2, 5.6), p(2.9, 4.6), p(2.4, 6.8), p(-0.4, 7.4), p(-0.2, 5.6)];
    let rose = [rose_front(), left, right];
    let found = seen(&rose);
    assert_eq!(found.first().map(|q| (q.kind, q.heads.len())), Some((Kind::Flower, 1)));
    assert!(found[0].parts.iter().filter(|q| q.class == StrokeClass::Blade).all(|q| q.root.is_some()));
    let is_flower = |lines: &[Vec<DVec2>]| seen(lines).iter().any(|q| q.kind == Kind::Flower);
    // One petal is too few, and leaves that touch with their bases stand off.
    assert!(!is_flower(&rose[..2]));
    let body = ring(p(0.0, 0.0), 3.0);
    let leaves = [leaf(p(-0.2, 3.1), p(-2.4, 6.0), 0.4), leaf(p(0.2, 3.1), p(2.4, 6.0), 0.4)];
    assert!(!is_flower(&[body, leaves[0].clone(), leaves[1].clone()]));
}

#[test]
fn bright_areas_above_green_ones_are_a_flower_and_below_them_are_not() {
    let area = |line: Vec<DVec2>, color: [u8; 3]| ink::Stroke {
        samples: line.into_iter().map(Into::into).collect(),
        color: Some(color),
        ..ink::Stroke::default()
    };
    let kinds = |up: f64| {
        let (red, dark, green) = ([220, 30, 40], [150, 20, 30], [60, 160, 40]);
        let strokes = vec![
            area(ring(p(0.0, 5.0 * up), 3.0), red),
            area(
                vec![
                    p(2.6, 5.0 * up - 1.0),
                    p(3.6, 5.0 * up + 3.0),
                    p(1.0, 5.0 * up + 2.6),
                    p(2.6, 5.0 * up - 1.0),
                ],
                dark,
            ),
            area(vec![p(-0.4, -4.0), p(0.4, -4.0), p(0.5, 2.2), p(-0.5, 2.2), p(-0.4, -4.0)], green),
            area(leaf(p(0.4, -2.0), p(4.0, 0.0), 0.4), green),
        ];
        let drawing = Drawing { strokes, ..Drawing::default() };
        propose(&ink::clean(&drawing, &mut base::Report::default()))
    };
    assert!(kinds(1.0).iter().any(|q| q.kind == Kind::Flower && q.heads.len() == 1));
    assert!(!kinds(-1.6).iter().any(|q| q.kind == Kind::Flower && q.heads.len() == 1));
}
