//! The partly understood drawing, and the small steps that belong to no other module.

use std::cell::RefCell;

use base::{LiteMap, Report};
use geom::{bounds, contains, polyline_length, signed_area};
use glam::DVec2;
use ink::{Classified, Ink, Source, StrokeClass, StrokeMode};
use plant::AxisKind;

use crate::blade::{Sheetlet, split_stalks};
use crate::branches::{Forest, Hints, Line};
use crate::contour::crown_outline;
use crate::kept::{Drawn, alike};
use crate::steady::steady;
use crate::structure::{Hidden, STRUCTURE, Structure};
use crate::thresholds::{MOUTH, STOPPED_SHORT, STRAIGHT};
use crate::{
    Attachment, AxisReading, BladeReading, DiscReading, FlowerReading, FruitReading, KeptStrokes, Kind,
    OrganWord, PotReading, Reading, RegionKind, RegionReading, StrokeReading, blade, palette, rings,
};

/// Most regions: nobody draws so many crowns, and each is led to by an axis. Further ones are left out.
pub(crate) const MOST_REGIONS: usize = 200;
/// A pot begins within this share of the height from the foot of the drawing.
const FOOT: f64 = 0.25;
/// Less than this share of the ink outside pots lies lower than the middle of a pot.
const BESIDE_A_POT: f64 = 0.2;
/// Greatest height of a pot relative to its width.
const TALLEST_POT: f64 = 2.0;
/// Scribbles smaller than this share of the sheet are dirt.
const SCRIBBLE_AREA: f64 = 0.008;
/// A thin outline is a petal seen edge-on if two others begin nearer than this share of their size.
const BESIDE: f64 = 0.25;
/// A blade closes where its stroke comes nearer to itself than this share of the gap between its ends.
const STALK_NEAR: f64 = 0.35;
/// A blade whose ends are nearer than this share of its length is closed.
const SHUT: f64 = 0.1;
/// A blade whose ends are farther apart than this share of its length is one side of a leaf.
const ONE_SIDE: f64 = 0.45;
/// Gaps between the halves of a fruit, a share of its outline.
pub(crate) const HALVES_GAPS: f64 = 0.2;

/// Lines are wood if more than this number of second-order branches come to one leaf or fruit.
const TWIGS_PER_ORGAN: usize = 2;

/// A thorn: root and tip, its bearer, its stroke.
pub(crate) type Thorn = (Vec<DVec2>, Option<Attachment>, Option<u32>);

/// A contour before its bearers are known.
#[derive(Clone, Debug)]
pub(crate) struct RegionDraft {
    pub(crate) outline: Vec<DVec2>,
    pub(crate) bounds: (DVec2, DVec2),
    pub(crate) kind: RegionKind,
    pub(crate) source: Option<u32>,
    pub(crate) color: Option<[u8; 3]>,
}

impl RegionDraft {
    /// Returns a point well inside, in the upper middle: a trunk is led to it.
    pub(crate) fn heart(&self) -> DVec2 {
        let c = geom::centroid(&self.outline);
        if contains(&self.outline, c) {
            c
        } else {
            self.outline[0].midpoint(self.outline[self.outline.len() / 2])
        }
    }
}

/// A flower before its petals are read.
#[derive(Clone, Debug, Default)]
pub(crate) struct FlowerDraft {
    pub(crate) centre: DVec2,
    /// Blades of the draft with their roots.
    pub(crate) petals: Vec<usize>,
    pub(crate) disc: Option<DiscReading>,
    pub(crate) stamens: Vec<Vec<DVec2>>,
}

/// A stem with leaves or petals along it that were drawn in one go.
#[derive(Clone, Debug)]
pub(crate) struct OneGo {
    /// Each begins and ends on the stem.
    pub(crate) loops: Vec<Vec<DVec2>>,
    pub(crate) stem: Vec<DVec2>,
}

/// The partly understood drawing.
#[derive(Debug)]
pub(crate) struct Draft<'a> {
    pub(crate) ink: &'a Ink,
    /// Results of strokes that are as they were.
    pub(crate) kept: &'a RefCell<KeptStrokes>,
    /// The kind that the whole is taken for, if that is known.
    pub(crate) kind: Option<Kind>,
    pub(crate) class: Vec<StrokeClass>,
    /// The class of each stroke before any rule.
    pub(crate) said: Vec<Classified>,
    /// The rule that gave a stroke its class.
    pub(crate) rule: Vec<Option<&'static str>>,
    pub(crate) organ: Vec<OrganWord>,
    /// Lines that will be axes.
    pub(crate) lines: Vec<Line>,
    pub(crate) blades: Vec<Sheetlet>,
    pub(crate) regions: Vec<RegionDraft>,
    pub(crate) forest: Forest,
    /// Rows of outlined bodies that stand on the ground.
    pub(crate) bodies: Vec<usize>,
    /// Two of the lines are surely the sides of a trunk.
    pub(crate) trunk: bool,
    /// A body is open above: a trunk, not a cactus.
    pub(crate) open_top: bool,
    /// Rows that were led on into a crown.
    pub(crate) led: Vec<usize>,
    /// Pots and the ground.
    pub(crate) soil: Vec<Vec<DVec2>>,
    /// Sides of trunks that were drawn in one go with a crown, and the crown's stroke.
    pub(crate) sides: Vec<(usize, Vec<DVec2>)>,
    /// The rest of those strokes.
    pub(crate) loops: LiteMap<usize, Vec<DVec2>>,
    /// Strokes whose class follows from the whole drawing: later rules do not change them.
    pub(crate) settled: Vec<bool>,
    /// Outlines that make up one crown.
    pub(crate) united: Vec<usize>,
    /// Lines that were drawn there and back in one go: the pieces of each such stroke.
    pub(crate) legs: LiteMap<usize, Vec<Vec<DVec2>>>,
    /// Petals that stand off their disc: the disc's stroke, and theirs.
    pub(crate) rings: Vec<(usize, Vec<usize>)>,
    /// Strokes that are a stem and leaves.
    pub(crate) one_go: LiteMap<usize, OneGo>,
    /// Completed outlines of the blades that go on behind others.
    pub(crate) hidden: LiteMap<usize, Hidden>,
    /// Petals of flowers that are known as a whole, by the strokes of each.
    pub(crate) heads: Vec<Vec<usize>>,
    /// Strokes that are leaves by their venation.
    pub(crate) veined: Vec<usize>,
    /// The strokes are already parts of a plant: none is cut in two.
    pub(crate) is_cut: bool,
}

impl<'a> Draft<'a> {
    pub(crate) fn new(ink: &'a Ink, classes: &[Classified], kept: &'a RefCell<KeptStrokes>) -> Self {
        let said: Vec<Classified> =
            (0..ink.strokes.len()).map(|k| classes.get(k).copied().unwrap_or_default()).collect();
        Self {
            ink,
            kept,
            kind: None,
            class: said.iter().map(|c| c.class).collect(),
            rule: vec![None; said.len()],
            settled: vec![false; said.len()],
            united: Vec::new(),
            said,
            organ: vec![OrganWord::Ignored; ink.strokes.len()],
            lines: Vec::new(),
            blades: Vec::new(),
            regions: Vec::new(),
            forest: Forest::new(),
            bodies: Vec::new(),
            trunk: false,
            open_top: false,
            led: Vec::new(),
            soil: Vec::new(),
            sides: Vec::new(),
            loops: LiteMap::new(),
            legs: LiteMap::new(),
            rings: Vec::new(),
            one_go: LiteMap::new(),
            hidden: LiteMap::new(),
            heads: Vec::new(),
            veined: Vec::new(),
            is_cut: false,
        }
    }

    /// Takes over the classes that the structure of the drawing gives: no later rule changes them.
    pub(crate) fn settle(&mut self, structure: &Structure) {
        for (k, class) in structure.classes().iter().enumerate() {
            if let Some(class) = *class {
                if self.class[k] != class {
                    self.rule[k] = Some(STRUCTURE);
                }
                self.class[k] = class;
                self.settled[k] = true;
            }
        }
        self.hidden = structure.hidden().clone();
        self.heads = structure.heads().to_vec();
        self.veined = structure.leaves().to_vec();
    }

    /// Whether the whole is taken for a tree: the line that stands is its trunk, and lines that leave it are
    /// branches.
    pub(crate) fn is_tree(&self) -> bool {
        self.kind.is_some_and(|k| k.is_like(Kind::Tree))
    }

    /// Returns the strokes of a class that were drawn in parts mode.
    pub(crate) fn strokes_of_class(&self, class: StrokeClass) -> Vec<usize> {
        (0..self.class.len())
            .filter(|&k| self.class[k] == class && self.ink.strokes[k].mode == StrokeMode::Parts)
            .collect()
    }

    /// Makes a stroke a line of the draft, or several where the pen went there and back.
    pub(crate) fn line_of(&mut self, stroke: usize, organ: OrganWord) {
        let s = &self.ink.strokes[stroke];
        self.organ[stroke] = organ;
        let whole = || vec![s.points.clone()];
        let pieces = self.legs.get(&stroke).cloned().unwrap_or_else(whole);
        let calm = |points: Vec<DVec2>| steady(&points).unwrap_or(points);
        self.lines
            .extend(pieces.into_iter().map(|points| Line { points: calm(points), source: Some(s.index) }));
    }

    pub(crate) fn set_organ(&mut self, source: Option<u32>, organ: OrganWord) {
        if let Some(Ok(k)) = source.map(|i| self.ink.strokes.binary_search_by_key(&i, |s| s.index)) {
            self.organ[k] = organ;
        }
    }

    pub(crate) fn add_region(&mut self, outline: Vec<DVec2>, kind: RegionKind, stroke: usize) {
        if let Some(bounds) = bounds(&outline) {
            let s = &self.ink.strokes[stroke];
            self.regions.push(RegionDraft { outline, bounds, kind, source: Some(s.index), color: s.color });
        }
    }

    /// Takes over the user's contours, whatever their class.
    pub(crate) fn contours(&mut self) {
        for k in 0..self.ink.strokes.len() {
            let (kind, organ) = match self.ink.strokes[k].mode {
                StrokeMode::Parts => continue,
                StrokeMode::BranchContour => (RegionKind::Twigs, OrganWord::TwigContour),
                StrokeMode::LeafContour => (RegionKind::Leaves, OrganWord::LeafContour),
            };
            if self.regions.len() < MOST_REGIONS
                && let Some(outline) = crown_outline(&self.ink.strokes[k].points)
            {
                self.organ[k] = organ;
                self.add_region(outline, kind, k);
            }
        }
    }

    pub(crate) fn find_soil(&mut self) {
        self.doubt_pots();
        for class in [StrokeClass::Pot, StrokeClass::Ground] {
            for k in self.strokes_of_class(class) {
                self.soil.push(self.ink.strokes[k].points.clone());
            }
        }
    }

    /// Returns the height of the ground: the ground line, the foot of the plant, or the sheet's lower edge.
    pub(crate) fn floor(&self) -> f64 {
        let ground = self.strokes_of_class(StrokeClass::Ground).into_iter().next();
        if let Some((lo, hi)) = ground.and_then(|k| bounds(&self.ink.strokes[k].points)) {
            return 0.5 * (lo.y + hi.y);
        }
        let axes = self.forest.axes.iter().filter(|a| a.kind != AxisKind::Root).flat_map(|a| &a.points);
        let crowns = self.regions.iter().map(|r| r.bounds.0.y);
        let low = axes.map(|p| p.y).chain(crowns).fold(f64::INFINITY, f64::min);
        if low.is_finite() { low } else { 0.0 }
    }

    /// Sorts outlines that enclose nothing because they come back the way they went: petals seen edge-on if two
    /// others begin where they do, else lines.
    fn edge_on(&mut self, thin: Vec<usize>) {
        for k in thin {
            let points = &self.ink.strokes[k].points;
            let root = points[0].midpoint(points[points.len() - 1]);
            let beside = |b: &&Sheetlet| b.gap.distance(root) < BESIDE * b.size;
            let petal = if self.blades.iter().filter(beside).take(2).count() == 2 {
                Sheetlet::edge_on(points, k)
            } else {
                None
            };
            match petal {
                Some(blade) => {
                    self.organ[k] = OrganWord::Leaf;
                    self.blades.push(blade);
                }
                None => self.line_of(k, OrganWord::Branch),
            }
        }
    }

    /// Turns blade strokes into outlines; joins half outlines and turns stalks into lines.
    pub(crate) fn blades(&mut self) {
        let ink = self.ink;
        let strokes = self.strokes_of_class(StrokeClass::Blade);
        let gap = |k: usize| {
            let s = &ink.strokes[k];
            s.points[0].distance(s.points[s.points.len() - 1]) / s.length
        };
        // Closed, with or without a stalk; or so open that it may be one side of a leaf.
        let (mut open, mut thin) = (Vec::new(), Vec::new());
        for k in strokes {
            let s = &ink.strokes[k];
            if let Some(parts) = self.one_go.get(&k) {
                let leaf =
                    |line: &Vec<DVec2>| Some(Sheetlet { root: Some(line[0]), ..Sheetlet::new(line, k)? });
                self.blades.extend(parts.loops.iter().filter_map(leaf));
                self.lines.push(Line { points: parts.stem.clone(), source: Some(s.index) });
                self.organ[k] = OrganWord::Leaf;
                continue;
            }
            if let Some(hidden) = self.hidden.get(&k)
                && let Some(blade) = Sheetlet::new(&hidden.outline, k)
            {
                self.blades.push(Sheetlet { root: hidden.root, ..blade });
                self.organ[k] = OrganWord::Leaf;
                continue;
            }
            let drawn = self.kept.borrow_mut().blades.get(
                s.index,
                |points| alike(points, &s.points),
                || s.points.clone(),
                || closed(&s.points, gap(k) > SHUT),
            );
            match drawn {
                Drawn::Open => open.push(k),
                Drawn::Thin => thin.push(k),
                Drawn::Blade(blade, stalks) => {
                    self.organ[k] = OrganWord::Leaf;
                    self.blades.push(Sheetlet { stroke: k, ..blade });
                    let source = Some(s.index);
                    self.lines.extend(stalks.into_iter().map(|points| Line { points, source }));
                }
            }
        }
        self.edge_on(thin);
        let points: Vec<&[DVec2]> = open.iter().map(|&k| ink.strokes[k].points.as_slice()).collect();
        let mut single = Vec::new();
        for ring in rings::rings(&points) {
            let parts: Vec<usize> = ring.parts.iter().map(|&p| open[p]).collect();
            // Only a part that is clearly one side of a leaf is completed by another stroke.
            let sides = parts.len() > 1 && parts.iter().any(|&k| gap(k) > ONE_SIDE);
            let blade = if sides { Sheetlet::new(&ring.points, parts[0]) } else { None };
            match blade {
                Some(blade) => {
                    parts.iter().for_each(|&k| self.organ[k] = OrganWord::Leaf);
                    self.blades.push(blade);
                }
                None => single.extend(parts),
            }
        }
        single.sort_unstable();
        for k in single {
            match Sheetlet::new(&ink.strokes[k].points, k) {
                Some(blade) => {
                    self.organ[k] = OrganWord::Leaf;
                    self.blades.push(blade);
                }
                None => self.line_of(k, OrganWord::Branch),
            }
        }
    }

    /// Marks blades with the venation of a leaf as leaves.
    pub(crate) fn veined_leaves(&mut self) {
        let veined = &self.veined;
        self.blades.iter_mut().for_each(|b| b.leaf |= veined.contains(&b.stroke));
    }

    /// Marks blades drawn in green as leaves if others, or a corolla, were drawn in another colour.
    pub(crate) fn green_leaves(&mut self) {
        let green = |k: usize| palette::is_green_stroke(&self.ink.strokes[k]);
        let corollas = self.strokes_of_class(StrokeClass::Corolla);
        if self.blades.iter().map(|b| b.stroke).chain(corollas).all(green) {
            return;
        }
        let leaves: Vec<bool> = self.blades.iter().map(|b| green(b.stroke)).collect();
        self.blades.iter_mut().zip(leaves).for_each(|(b, green)| b.leaf |= green);
    }

    /// Turns large scribbles into the crown if nothing else could be one.
    pub(crate) fn scribbled_crowns(&mut self, report: &mut Report) {
        if !self.regions.is_empty() || !self.blades.is_empty() || (!self.bodies.is_empty() && !self.open_top)
        {
            return;
        }
        for k in self.strokes_of_class(StrokeClass::Scribble) {
            let hull = self.ink.strokes[k].hull();
            let free = self.organ[k] == OrganWord::Ignored && signed_area(hull) > SCRIBBLE_AREA;
            let shading = hull.len() > 2 && self.forest.nearest(geom::centroid(hull), 0.005).is_some();
            if free && !shading && self.regions.len() < MOST_REGIONS {
                self.crown_from(k, report);
            }
        }
    }

    pub(crate) fn crown_from(&mut self, k: usize, report: &mut Report) -> bool {
        let Some(outline) = crown_outline(&self.ink.strokes[k].points) else { return false };
        self.organ[k] = OrganWord::LeafContour;
        self.add_region(outline, RegionKind::Crown, k);
        let index = self.ink.strokes[k].index;
        base::warn!(
            report,
            "scribble",
            { stroke = index },
            "stroke {stroke} is a scribble and was read as a crown of leaves"
        );
        true
    }

    /// Makes a plant of the longest stroke if nothing else could be read in the drawing.
    pub(crate) fn last_resort(&mut self, discs: &[(DiscReading, usize)], report: &mut Report) {
        let something = !self.lines.is_empty()
            || !self.blades.is_empty()
            || !self.regions.is_empty()
            || !self.forest.axes.is_empty()
            || !discs.is_empty()
            || self
                .strokes_of_class(StrokeClass::Fruit)
                .into_iter()
                .any(|k| self.ink.strokes[k].outline().is_some());
        if something {
            return;
        }
        let strokes = &self.ink.strokes;
        let Some(k) = (0..strokes.len())
            .max_by(|&a, &b| strokes[a].length.total_cmp(&strokes[b].length).then(b.cmp(&a)))
        else {
            return;
        };
        // The drawing has nothing but soil: the strokes taken for soil are the plant.
        self.soil.clear();
        let s = &strokes[k];
        let straight = s.points[0].distance(s.points[s.points.len() - 1]) > STRAIGHT * s.length;
        if straight || !self.crown_from(k, report) {
            self.line_of(k, OrganWord::Branch);
            base::warn!(
                report,
                "scribble-stem",
                { stroke = s.index },
                "stroke {stroke} was read as a stem, because nothing else fits it"
            );
        }
    }

    /// Cuts off lines that were drawn inside the pot: stems begin at its rim.
    pub(crate) fn trim_at_pots(&mut self) {
        let pots: Vec<&[DVec2]> = self
            .strokes_of_class(StrokeClass::Pot)
            .into_iter()
            .take(MOST_REGIONS)
            .filter_map(|k| self.ink.strokes[k].outline())
            .collect();
        let deep = |p: DVec2| {
            pots.iter().any(|pot| contains(pot, p) && blade::nearest_on_ring(pot, p).1 > STOPPED_SHORT)
        };
        if pots.is_empty() {
            return;
        }
        for line in &mut self.lines {
            for _ in 0..2 {
                line.points.reverse();
                if !deep(line.points[0]) {
                    continue;
                }
                let out = line.points.iter().position(|&p| !pots.iter().any(|pot| contains(pot, p)));
                if let Some(out) = out.filter(|&o| o + 1 < line.points.len()) {
                    line.points.drain(..out);
                }
            }
        }
    }

    pub(crate) fn fruits(&mut self, nuts: &[usize]) -> Vec<FruitReading> {
        let mut strokes = self.strokes_of_class(StrokeClass::Fruit);
        strokes.extend(nuts);
        strokes.sort_unstable();
        let mut fruits = Vec::new();
        for k in self.joined_fruits(&mut strokes, &mut fruits) {
            let s = &self.ink.strokes[k];
            if let Some(outline) = s.outline().map(<[DVec2]>::to_vec) {
                self.organ[k] = OrganWord::Fruit;
                fruits.push(FruitReading { outline, bearer: None, source: Some(s.index), color: s.color });
            }
        }
        fruits
    }

    /// Joins outlines that were drawn in several lines if the whole is a fruit or a root. If the kind is not known
    /// and nothing else has an inside, joins halves that close well. Leaves the other strokes.
    fn joined_fruits(&mut self, strokes: &mut Vec<usize>, fruits: &mut Vec<FruitReading>) -> Vec<usize> {
        let whole = self.kind.is_some_and(|k| k.is_like(Kind::Fruit));
        let open = |k: &usize| {
            let s = &self.ink.strokes[*k];
            s.points[0].distance(s.points[s.points.len() - 1]) > MOUTH * s.length
        };
        let alone = self.kind.is_none() && self.regions.is_empty() && self.bodies.is_empty();
        if !whole && !alone {
            return core::mem::take(strokes);
        }
        let (lines, mut rest): (Vec<usize>, Vec<usize>) = strokes.iter().partition(|k| open(k));
        let points: Vec<&[DVec2]> = lines.iter().map(|&k| self.ink.strokes[k].points.as_slice()).collect();
        for ring in rings::rings(&points) {
            let outline = geom::simple_outline(&ring.points).filter(|_| ring.parts.len() > 1);
            let gaps: f64 = ring.gaps.iter().map(|&g| ring.gap(g)).map(|(a, b)| a.distance(b)).sum();
            let drawn: f64 = ring.drawn().iter().map(|d| polyline_length(d)).sum();
            let Some(outline) = outline.filter(|_| whole || gaps < HALVES_GAPS * drawn) else {
                rest.extend(ring.parts.iter().map(|&p| lines[p]));
                continue;
            };
            ring.parts.iter().for_each(|&p| self.organ[lines[p]] = OrganWord::Fruit);
            let s = &self.ink.strokes[lines[ring.parts[0]]];
            fruits.push(FruitReading { outline, bearer: None, source: Some(s.index), color: s.color });
        }
        rest.sort_unstable();
        rest
    }

    /// Returns hints to where stems begin and end; `flowers`: their centres.
    pub(crate) fn hints(&self, flowers: &[DVec2]) -> Hints {
        let mut hints = Hints::default();
        for (i, blade) in self.blades.iter().enumerate() {
            hints.organs.add_line(i, &blade.outline);
        }
        for (i, &centre) in flowers.iter().enumerate() {
            hints.organs.add_line(i, &[centre]);
        }
        for (i, region) in self.regions.iter().enumerate() {
            hints.organs.add_line(i, &region.outline);
        }
        for (i, soil) in self.soil.iter().enumerate() {
            hints.soil.add_line(i, soil);
        }
        hints
    }

    /// Returns how a stroke was read, and the source of its class.
    fn stroke(&self, k: usize) -> StrokeReading {
        let (class, said) = (self.class[k], &self.said[k]);
        let (source, confidence) = match self.rule[k] {
            Some(name) if class != said.class => (Source::Rule(name), said.shares[class.place()]),
            _ => (said.source, said.confidence),
        };
        StrokeReading { index: self.ink.strokes[k].index, class, organ: self.organ[k], confidence, source }
    }

    pub(crate) fn finish(
        mut self,
        region_bearers: Vec<Vec<usize>>,
        flowers: Vec<FlowerReading>,
        leaves: Vec<BladeReading>,
        fruits: Vec<FruitReading>,
        thorns: Vec<Thorn>,
    ) -> Reading {
        let pots = self.pots();
        let mut strokes: Vec<StrokeReading> = (0..self.class.len()).map(|k| self.stroke(k)).collect();
        let crown = self.regions.iter().any(|r| r.kind != RegionKind::Leaves);
        let trunk = !self.bodies.is_empty()
            && (self.open_top || !leaves.is_empty())
            && !is_stem_of_flowers(&flowers, &self.forest.axes);
        let orders = self.forest.order.iter().copied().max().unwrap_or(0);
        // The rachis of a compound leaf, and the stalks of a raceme, bear an organ each: they are no branches of wood.
        let twigs = self.forest.order.iter().filter(|order| **order >= 2).count();
        let is_bare = flowers.is_empty() && twigs > TWIGS_PER_ORGAN * (leaves.len() + fruits.len());
        let lines = orders >= 2 && is_bare && self.bodies.is_empty();
        let bare = self.is_tree() && orders >= 1;
        let woody = (crown || trunk || lines || bare) && !palette::is_herb(self.ink);
        for axis in &mut self.forest.axes {
            if axis.kind == AxisKind::Stem && woody {
                axis.kind = AxisKind::Branch;
            }
        }
        let regions = self
            .regions
            .into_iter()
            .zip(region_bearers)
            .filter(|(_, bearers)| !bearers.is_empty())
            .map(|(r, bearers)| RegionReading {
                outline: r.outline,
                kind: r.kind,
                bearers,
                source: r.source,
                color: r.color,
            })
            .collect();
        strokes.extend(self.ink.skipped.iter().copied().map(StrokeReading::left_out));
        base::sort_by_key(&mut strokes, |s| s.index);
        Reading {
            strokes,
            axes: self.forest.axes,
            flowers,
            leaves,
            regions,
            fruits,
            pots,
            thorns,
            woody,
            pressed: Vec::new(),
            plants: Vec::new(),
        }
    }

    /// Groups the strokes of pots that stand at the foot of the drawing: low and high corner, rows. Strokes above one
    /// another are of one pot.
    fn pot_groups(&self) -> Vec<(DVec2, DVec2, Vec<usize>)> {
        let heights = self.ink.strokes.iter().flat_map(|s| &s.points).map(|p| p.y);
        let (floor, top) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), y| (l.min(y), h.max(y)));
        let mut found: Vec<(DVec2, DVec2, Vec<usize>)> = Vec::new();
        for k in self.strokes_of_class(StrokeClass::Pot) {
            let Some((low, high)) = bounds(&self.ink.strokes[k].points) else { continue };
            let mut one = (low, high, vec![k]);
            for other in found.extract_if(.., |(l, h, _)| l.x <= high.x && low.x <= h.x) {
                one.2.splice(0..0, other.2);
                (one.0, one.1) = (one.0.min(other.0), one.1.max(other.1));
            }
            found.push(one);
        }
        found.retain(|(low, ..)| low.y < floor + FOOT * (top - floor));
        found
    }

    /// Turns strokes that only the classifier takes for pots into lines if no pot can be there: much of the plant
    /// lies as low as they do, or they do not have the shape of a pot.
    fn doubt_pots(&mut self) {
        let said = self.strokes_of_class(StrokeClass::Pot);
        let is_said = |k: &usize| {
            self.settled[*k] || self.said[*k].source == Source::User || self.said[*k].shown.is_some()
        };
        if said.is_empty() || said.iter().any(is_said) {
            return;
        }
        let points: Vec<DVec2> = (0..self.class.len())
            .filter(|&k| self.class[k] != StrokeClass::Ground && !said.contains(&k))
            .flat_map(|k| self.ink.strokes[k].points.iter().copied())
            .collect();
        #[expect(clippy::cast_precision_loss, reason = "points")]
        let is_pot = |(low, high, _): &(DVec2, DVec2, Vec<usize>)| {
            let size = *high - *low;
            let middle = low.y.midpoint(high.y);
            let beside = points.iter().filter(|p| p.y < middle).count() as f64;
            beside <= BESIDE_A_POT * points.len() as f64 && size.y < TALLEST_POT * size.x
        };
        let pots: Vec<usize> =
            self.pot_groups().into_iter().filter(is_pot).flat_map(|(.., rows)| rows).collect();
        said.into_iter().filter(|k| !pots.contains(k)).for_each(|k| self.class[k] = StrokeClass::Axis);
    }

    fn pots(&mut self) -> Vec<PotReading> {
        let found = self.pot_groups();
        found
            .into_iter()
            .filter_map(|(.., rows)| {
                rows.iter().for_each(|&k| self.organ[k] = OrganWord::Pot);
                let strokes: Vec<&ink::InkStroke> = rows.iter().map(|&k| &self.ink.strokes[k]).collect();
                let first = strokes.first()?;
                let lines = strokes.iter().map(|s| s.points.clone()).collect();
                Some(PotReading { lines, source: Some(first.index), color: first.color })
            })
            .collect()
    }

    /// Returns the length of the longest line or axis.
    pub(crate) fn longest(&self) -> f64 {
        let lines = self.lines.iter().map(|l| polyline_length(&l.points));
        lines.chain((0..self.forest.axes.len()).map(|r| self.forest.length(r))).fold(0.0, f64::max)
    }
}

/// Returns the form of a single blade stroke. `apart`: its ends are apart.
fn closed(points: &[DVec2], apart: bool) -> Drawn {
    if let Some(blade) = Sheetlet::with_rib(points, 0) {
        return Drawn::Blade(blade, Vec::new());
    }
    let (line, stalks) = split_stalks(points, STALK_NEAR);
    if stalks.is_empty() && apart {
        return Drawn::Open;
    }
    Sheetlet::new(&line, 0).map_or(Drawn::Thin, |blade| Drawn::Blade(blade, stalks))
}

/// Whether a stem drawn by both its sides is that of a herb: it bears a flower that is much wider than itself.
/// Blossoms are small compared with the trunk of their tree.
fn is_stem_of_flowers(flowers: &[FlowerReading], axes: &[AxisReading]) -> bool {
    /// Reach of such a flower relative to the usual half width of the stem.
    const WIDER: f64 = 3.0;
    let reach = |f: &FlowerReading| f.petals.iter().map(|p| p.tip.distance(f.centre)).fold(0.0, f64::max);
    let widest = axes.iter().filter_map(|a| base::median(a.half_width.clone())).fold(0.0, f64::max);
    widest > 0.0 && flowers.iter().any(|f| reach(f) > WIDER * widest)
}
