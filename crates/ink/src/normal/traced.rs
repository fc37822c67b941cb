//! Areas that are ink, traced or expanded by a program -> the centre lines of connected parts.
//!
//! Rings -> raster -> thinned to one cell (Zhang and Suen 1984) -> edges between ends and junctions -> short spurs are
//! removed, and lines run straight on through junctions.

use glam::DVec2;

use super::{Change, Extent, Figure, LIMITS, Work, places};
use crate::InkSample;

/// Ink is this many times longer than wide; a leaf of 1 : 8 is 12 times as long as it is wide on the average.
const SLENDER: f64 = 14.0;
/// Ink of any form is no wider than this share of the drawing's diagonal.
const WIDEST: f64 = 0.035;
/// Ink of an even width, as that of an icon, is no wider than this share of the drawing's diagonal.
const WIDEST_OF_ICON: f64 = 0.09;
/// Ink has an even width if the distance of its middle from its edge varies by at most this share of its mean (standard
/// deviation): a pen has one width, a silhouette has none.
const EVEN: f64 = 0.25;
/// Number of places at which the width of a part is measured.
const PLACES: usize = 160;
/// Least share of slender parts among all outlines of a figure.
const MOSTLY: f64 = 0.6;
/// Number of cells across the width of a line.
const CELLS: f64 = 3.5;
/// Most cells of the raster of one part.
const MOST_CELLS: f64 = 3e6;
/// Most cells of the rasters of all parts together.
const MOST_CELLS_IN_ALL: f64 = 1.2e7;
/// Most rings of all figures together.
const MOST_RINGS: usize = 4000;
/// Ends shorter than this many widths are corners of the outline rather than lines.
const SPUR: f64 = 1.6;
/// The same for the wide lines of an icon, some of which are hardly longer than wide.
const SPUR_OF_ICON: f64 = 1.0;
/// Two edges continue each other where the angle between them is below 60 degrees.
const STRAIGHT_ON: f64 = -0.5;
/// Parts without holes that are no longer than this many widths are specks.
const SPECK: f64 = 2.0;

/// An outer ring and the holes in it.
struct Part {
    rings: Vec<Vec<DVec2>>,
    area: f64,
    around: f64,
}

impl Part {
    fn width(&self) -> f64 {
        2.0 * self.area / self.around
    }

    fn is_slender(&self, diagonal: f64) -> bool {
        let width = self.width();
        width > 0.0
            && 0.5 * self.around >= SLENDER * width
            && (width <= WIDEST * diagonal || width <= WIDEST_OF_ICON * diagonal && self.is_even())
    }

    /// Whether it is equally wide everywhere.
    fn is_even(&self) -> bool {
        let width = self.width();
        let cell = cell_of(self, width);
        if part_cells(self, cell) > MOST_CELLS {
            return false;
        }
        let middle: Vec<DVec2> =
            centre_lines(self, cell, width, SPUR_OF_ICON * width).into_iter().flatten().collect();
        let rings: Vec<Vec<DVec2>> =
            self.rings.iter().map(|ring| ring.iter().chain(ring.first()).copied().collect()).collect();
        let off = |p: DVec2| {
            rings.iter().filter_map(|r| geom::distance_to_polyline(r, p)).fold(f64::INFINITY, f64::min)
        };
        let half: Vec<f64> = super::some_of(&middle, PLACES).map(off).collect();
        #[expect(clippy::cast_precision_loss, reason = "a few places")]
        let count = half.len() as f64;
        let mean = half.iter().sum::<f64>() / count;
        let square = half.iter().map(|h| (h - mean) * (h - mean)).sum::<f64>() / count;
        count > 0.0 && square.sqrt() <= EVEN * mean
    }
}

impl Work {
    /// Replaces areas that are mostly slender by centre lines, with their width as the pen's.
    pub(super) fn take_traced_ink(&mut self) {
        let diagonal = self.diagonal();
        let mut cells = 0.0;
        let mut reduced = 0;
        let rings: usize = self.figures.iter().filter(|f| !f.lined).map(|f| f.lines.len()).sum();
        if rings > MOST_RINGS {
            return;
        }
        let mut unseen = 0;
        for row in 0..self.figures.len() {
            let figure = &self.figures[row];
            if figure.lined || !figure.fill.is_some_and(|f| f.said) {
                continue;
            }
            let parts = parts_of(figure);
            let slender: Vec<bool> = parts.iter().map(|p| p.is_slender(diagonal)).collect();
            let sum = |measure: fn(&Part) -> f64| {
                parts.iter().zip(&slender).filter(|(_, s)| **s).map(|(p, _)| measure(p)).sum::<f64>()
            };
            let around: f64 = parts.iter().map(|p| p.around).sum();
            let ink = sum(|p| p.around);
            if ink < MOSTLY * around || ink <= 0.0 {
                continue;
            }
            if self.is_unseen(row) {
                unseen += figure.lines.len();
                self.figures[row].lines.clear();
                continue;
            }
            let mut lines = Vec::new();
            let pen = sum(|p| p.area) * 2.0 / ink;
            let spur = pen * if pen > WIDEST * diagonal { SPUR_OF_ICON } else { SPUR };
            for (part, is_slender) in parts.iter().zip(&slender) {
                if *is_slender {
                    let cell = cell_of(part, pen);
                    cells += part_cells(part, cell);
                    if cells <= MOST_CELLS_IN_ALL {
                        lines.extend(centre_lines(part, cell, pen, spur));
                    }
                } else if Extent::from_line(&samples(&part.rings[0]))
                    .is_some_and(|e| e.size().length() > 2.0 * SPECK * pen)
                {
                    lines.extend(part.rings.iter().cloned());
                }
            }
            if lines.is_empty() || cells > MOST_CELLS_IN_ALL {
                continue;
            }
            reduced += 1;
            let figure = &mut self.figures[row];
            figure.lines = lines.iter().map(|l| samples(l)).collect();
            figure.like.color = figure.like.color.or(figure.fill.and_then(|f| f.color));
            figure.like.width = Some(pen);
            (figure.lined, figure.fill) = (true, None);
        }
        self.figures.retain(|f| !f.lines.is_empty());
        self.note(Change::Paper, unseen);
        self.note(Change::TracedInk, reduced);
    }

    /// Whether a figure is white and lies on white paper: nothing of another colour was painted below it, but something
    /// was elsewhere.
    fn is_unseen(&self, row: usize) -> bool {
        let is_white = |f: &Figure| f.color_seen().is_some_and(|c| c.iter().all(|x| *x >= LIMITS.white));
        let extent = |f: &Figure| f.lines.iter().filter_map(|l| Extent::from_line(l)).reduce(Extent::with);
        let own = extent(&self.figures[row]);
        let meets = |f: &Figure| extent(f).zip(own).is_some_and(|(e, own)| e.meets(own));
        is_white(&self.figures[row])
            && !self.figures.iter().all(is_white)
            && !self.figures[..row].iter().any(|f| !is_white(f) && meets(f))
    }
}

fn samples(line: &[DVec2]) -> Vec<InkSample> {
    line.iter().map(|&p| p.into()).collect()
}

/// Groups the rings of a figure by what they enclose: a ring in an odd number of others is a hole of the smallest of
/// them.
fn parts_of(figure: &Figure) -> Vec<Part> {
    let mut rings: Vec<(f64, Vec<DVec2>)> = figure
        .lines
        .iter()
        .map(|l| places(l))
        .filter(|l| l.len() > 3 && l.iter().all(|p| p.abs().max_element() < 1e100))
        .map(|l| (geom::signed_area(&l).abs(), l))
        .filter(|(area, _)| *area > 0.0)
        .collect();
    base::sort_by(&mut rings, |a, b| b.0.total_cmp(&a.0));
    let even_odd = figure.fill.is_some_and(|f| f.even_odd);
    let turned = |ring: &[DVec2]| geom::signed_area(ring) > 0.0;
    let mut parts: Vec<Part> = Vec::new();
    for (area, ring) in rings {
        let around = geom::perimeter(&ring);
        let at = ring[0].midpoint(ring[1]);
        let holder = parts.iter_mut().rev().find(|p| geom::contains(&p.rings[0], at));
        let in_hole = |part: &Part| part.rings[1..].iter().any(|hole| geom::contains(hole, at));
        match holder {
            // A ring that runs in the same direction paints what is painted already.
            Some(part) if !in_hole(part) && !even_odd && turned(&part.rings[0]) == turned(&ring) => {}
            Some(part) if !in_hole(part) => {
                part.area -= area;
                part.around += around;
                part.rings.push(ring);
            }
            _ => parts.push(Part { rings: vec![ring], area, around }),
        }
    }
    parts
}

fn box_of(part: &Part) -> (DVec2, DVec2) {
    geom::bounds(&part.rings[0]).unwrap_or_default()
}

/// Returns the side of a cell: a few across a line's width, and not too many in all.
fn cell_of(part: &Part, pen: f64) -> f64 {
    let (lo, hi) = box_of(part);
    let size = hi - lo;
    (pen / CELLS).max((size.x * size.y / MOST_CELLS).sqrt()).max(size.max_element() / 4000.0)
}

fn part_cells(part: &Part, cell: f64) -> f64 {
    let (lo, hi) = box_of(part);
    let size = (hi - lo) / cell + 4.0;
    size.x * size.y
}

/// A cell by its column and row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Cell {
    x: i32,
    y: i32,
}

impl Cell {
    const fn new(x: i32, y: i32) -> Self {
        Self { x, y }
    }
}

impl core::ops::Add for Cell {
    type Output = Self;

    fn add(self, by: Self) -> Self {
        Self { x: self.x + by.x, y: self.y + by.y }
    }
}

/// Inked cells.
struct Raster {
    wide: i32,
    high: i32,
    on: Vec<bool>,
    origin: DVec2,
    cell: f64,
}

/// The eight neighbours in circular order.
const AROUND: [Cell; 8] = [
    Cell::new(0, 1),
    Cell::new(1, 1),
    Cell::new(1, 0),
    Cell::new(1, -1),
    Cell::new(0, -1),
    Cell::new(-1, -1),
    Cell::new(-1, 0),
    Cell::new(-1, 1),
];

impl Raster {
    #[expect(clippy::cast_possible_truncation, reason = "the number of cells is bounded")]
    fn new(part: &Part, cell: f64) -> Self {
        let (lo, hi) = box_of(part);
        let size = (hi - lo) / cell;
        let (wide, high) = (size.x.ceil() as i32 + 4, size.y.ceil() as i32 + 4);
        let origin = lo - cell * 1.5;
        let mut raster = Self { wide, high, on: Vec::new(), origin, cell };
        raster.on = vec![false; raster.row(Cell::new(0, high))];
        let mut crossings: Vec<Vec<f64>> = (0..high).map(|_| Vec::new()).collect();
        for ring in &part.rings {
            let closing = ring.last().copied().into_iter().chain(ring.iter().copied());
            for (a, b) in closing.zip(ring.iter().copied()) {
                let (a, b) = ((a - origin) / cell, (b - origin) / cell);
                let (low, top) = if a.y <= b.y { (a, b) } else { (b, a) };
                // A row of cells is crossed where its middle lies between the ends.
                let first = (low.y - 0.5).ceil().max(0.0) as i32;
                let last = ((top.y - 0.5).ceil() as i32).min(high);
                for y in first..last {
                    let t = (f64::from(y) + 0.5 - low.y) / (top.y - low.y);
                    crossings[usize::try_from(y).unwrap_or_default()].push(low.x + t * (top.x - low.x));
                }
            }
        }
        for (y, row) in (0..high).zip(&mut crossings) {
            base::sort_numbers(row);
            for pair in row.chunks_exact(2) {
                let (from, to) = ((pair[0] - 0.5).ceil().max(0.0) as i32, (pair[1] - 0.5).ceil() as i32);
                for x in from..to.min(wide) {
                    let row = raster.row(Cell::new(x, y));
                    raster.on[row] = true;
                }
            }
        }
        raster
    }

    fn row(&self, at: Cell) -> usize {
        usize::try_from(at.y * self.wide + at.x).unwrap_or_default()
    }

    fn has(&self, at: Cell) -> bool {
        (0..self.wide).contains(&at.x) && (0..self.high).contains(&at.y) && self.on[self.row(at)]
    }

    fn ring(&self, at: Cell) -> [bool; 8] {
        AROUND.map(|by| self.has(at + by))
    }

    fn inked(&self) -> Vec<Cell> {
        let cells = (0..self.high).flat_map(|y| (0..self.wide).map(move |x| Cell::new(x, y)));
        cells.filter(|c| self.on[self.row(*c)]).collect()
    }

    /// Thins the ink (Zhang and Suen 1984): peels cells from both sides until one is left.
    fn thin(&mut self) {
        let mut cells = self.inked();
        loop {
            let before = cells.len();
            for odd in [false, true] {
                let goes: Vec<Cell> =
                    cells.iter().copied().filter(|c| is_peeled(&self.ring(*c), odd)).collect();
                for cell in goes {
                    let row = self.row(cell);
                    self.on[row] = false;
                }
                cells.retain(|c| self.on[self.row(*c)]);
            }
            if cells.len() == before {
                break;
            }
        }
        // Steps of a staircase: their neighbours are connected without them.
        for cell in cells {
            let r = self.ring(cell);
            let corner = |a: usize, b: usize, far: usize| r[a] && r[b] && !r[far];
            let stair = [(0, 2, 5), (2, 4, 7), (4, 6, 1), (6, 0, 3)].into_iter();
            let alone = steps_up(&r) == 1 || r.iter().filter(|n| **n).count() == 2;
            if alone
                && stair.into_iter().any(|(a, b, far)| corner(a, b, far))
                && r.iter().filter(|n| **n).count() < 4
            {
                let row = self.row(cell);
                self.on[row] = false;
            }
        }
    }

    fn place(&self, at: Cell) -> DVec2 {
        self.origin + (DVec2::new(f64::from(at.x), f64::from(at.y)) + 0.5) * self.cell
    }
}

/// Counts how often a neighbour that is not inked is followed by one that is.
fn steps_up(ring: &[bool; 8]) -> usize {
    (0..8).filter(|&k| !ring[k] && ring[(k + 1) % 8]).count()
}

fn is_peeled(ring: &[bool; 8], odd: bool) -> bool {
    let count = ring.iter().filter(|n| **n).count();
    let [up, _, right, _, down, _, left, _] = *ring;
    let open = if odd { !(up && left && (right || down)) } else { !(right && down && (up || left)) };
    (2..=6).contains(&count) && steps_up(ring) == 1 && open
}

/// A path between two nodes of the thinned ink; `None` for a ring without any.
struct Edge {
    points: Vec<DVec2>,
    ends: [Option<usize>; 2],
    gone: bool,
}

impl Edge {
    fn length(&self) -> f64 {
        geom::polyline_length(&self.points)
    }

    /// Returns the direction from one of its ends inwards.
    fn direction(&self, end: usize, reach: f64) -> DVec2 {
        let mut way: Vec<DVec2> = self.points.clone();
        if end == 1 {
            way.reverse();
        }
        let along = geom::point_at(&way, reach.min(geom::polyline_length(&way)));
        along.zip(way.first()).map_or(DVec2::ZERO, |(to, from)| (to - from).normalize_or_zero())
    }
}

/// Returns the centre lines of one part, the longest path through each junction; ends shorter than `spur` are none.
fn centre_lines(part: &Part, cell: f64, pen: f64, spur: f64) -> Vec<Vec<DVec2>> {
    let mut raster = Raster::new(part, cell);
    raster.thin();
    let mut edges = edges_of(&raster);
    prune(&mut edges, spur);
    let lines = run_through(&edges, 2.5 * pen);
    let smooth = |line: Vec<DVec2>| {
        let closed = line.len() > 3 && line.first() == line.last();
        let even = geom::resample(&line, cell);
        let mut even = if closed { round(&even) } else { eased(&even) };
        even.dedup();
        geom::simplify(&even, 0.15 * cell)
    };
    let long = |l: &Vec<DVec2>| geom::polyline_length(l) >= spur;
    lines.into_iter().map(smooth).filter(long).collect()
}

/// Half of the number of points that are averaged: cells make small steps.
const EASED: usize = 4;

/// Averages neighbours; both ends stay.
fn eased(line: &[DVec2]) -> Vec<DVec2> {
    let last = line.len().saturating_sub(1);
    let mean = |k: usize| {
        let m = EASED.min(k).min(last - k);
        mean_of(&line[k - m..=k + m])
    };
    (0..line.len()).map(mean).collect()
}

/// Averages neighbours round a closed line.
fn round(line: &[DVec2]) -> Vec<DVec2> {
    let n = line.len() - 1;
    if n <= 2 * EASED {
        return line.to_vec();
    }
    let mut out: Vec<DVec2> = (0..n)
        .map(|k| {
            let near: Vec<DVec2> = (0..=2 * EASED).map(|j| line[(k + n + j - EASED) % n]).collect();
            mean_of(&near)
        })
        .collect();
    out.push(out[0]);
    out
}

#[expect(clippy::cast_precision_loss, reason = "a few points")]
fn mean_of(points: &[DVec2]) -> DVec2 {
    points.iter().sum::<DVec2>() / points.len().max(1) as f64
}

fn edges_of(raster: &Raster) -> Vec<Edge> {
    let cells = raster.inked();
    let count = |c: Cell| raster.ring(c).iter().filter(|n| **n).count();
    // Nodes: cells with other than two neighbours; touching ones form one node.
    let mut node_of: Vec<Option<usize>> = vec![None; raster.on.len()];
    let mut places: Vec<DVec2> = Vec::new();
    for &start in cells.iter().filter(|c| count(**c) != 2) {
        if node_of[raster.row(start)].is_some() {
            continue;
        }
        let node = places.len();
        node_of[raster.row(start)] = Some(node);
        let (mut stack, mut all) = (vec![start], Vec::new());
        while let Some(at) = stack.pop() {
            all.push(raster.place(at));
            for next in AROUND.map(|by| at + by) {
                if raster.has(next) && count(next) > 2 && node_of[raster.row(next)].is_none() {
                    node_of[raster.row(next)] = Some(node);
                    stack.push(next);
                }
            }
        }
        places.push(mean_of(&all));
    }
    let mut seen = vec![false; raster.on.len()];
    let mut edges = Vec::new();
    for &cell in &cells {
        let Some(node) = node_of[raster.row(cell)] else { continue };
        for next in AROUND.map(|by| cell + by) {
            if raster.has(next) && node_of[raster.row(next)].is_none() && !seen[raster.row(next)] {
                edges.push(walk(raster, &node_of, &mut seen, &places, (Some((node, cell)), next)));
            }
        }
    }
    for &cell in &cells {
        if node_of[raster.row(cell)].is_none() && !seen[raster.row(cell)] {
            let mut edge = walk(raster, &node_of, &mut seen, &places, (None, cell));
            edge.points.extend(edge.points.first().copied());
            edges.push(edge);
        }
    }
    edges
}

/// Follows cells with two neighbours to the next node, or round.
fn walk(
    raster: &Raster,
    node_of: &[Option<usize>],
    seen: &mut [bool],
    places: &[DVec2],
    (from, start): (Option<(usize, Cell)>, Cell),
) -> Edge {
    let mut points: Vec<DVec2> = from.iter().map(|(node, _)| places[*node]).collect();
    let (mut before, mut at) = (from.map_or(start, |(_, cell)| cell), start);
    let mut ends = [from.map(|(node, _)| node), None];
    loop {
        seen[raster.row(at)] = true;
        points.push(raster.place(at));
        let near = || AROUND.map(|by| at + by).into_iter().filter(|n| raster.has(*n) && *n != before);
        let own = |n: &Cell| from.is_some_and(|(node, _)| node_of[raster.row(*n)] == Some(node));
        let early = points.len() < 4;
        let node = near().find(|n| node_of[raster.row(*n)].is_some() && !(early && own(n)));
        if let Some(node) = node.and_then(|n| node_of[raster.row(n)]) {
            points.push(places[node]);
            ends[1] = Some(node);
            break;
        }
        let Some(next) = near().find(|n| node_of[raster.row(*n)].is_none() && !seen[raster.row(*n)]) else {
            break;
        };
        (before, at) = (at, next);
    }
    Edge { points, ends, gone: false }
}

/// Returns the edges that end at each node, with which of their ends.
fn nodes_of(edges: &[Edge]) -> Vec<Vec<(usize, usize)>> {
    let most = edges.iter().flat_map(|e| e.ends).flatten().max().map_or(0, |n| n + 1);
    let mut nodes: Vec<Vec<(usize, usize)>> = vec![Vec::new(); most];
    for (k, edge) in edges.iter().enumerate().filter(|(_, e)| !e.gone) {
        for (end, node) in edge.ends.iter().enumerate() {
            if let Some(node) = node {
                nodes[*node].push((k, end));
            }
        }
    }
    nodes
}

/// Removes short edges with a free end at a junction.
fn prune(edges: &mut [Edge], short: f64) {
    let nodes = nodes_of(edges);
    let degree = |node: Option<usize>| node.map_or(1, |n| nodes[n].len());
    let goes: Vec<usize> = (0..edges.len())
        .filter(|&k| {
            let [a, b] = edges[k].ends.map(degree);
            a.min(b) == 1 && a.max(b) > 2 && edges[k].length() < short
        })
        .collect();
    for k in goes {
        edges[k].gone = true;
    }
}

/// Joins lines that continue straight through junctions; an edge that returns to its beginning is a line by itself.
fn run_through(edges: &[Edge], reach: f64) -> Vec<Vec<DVec2>> {
    let mut on: Vec<[Option<(usize, usize)>; 2]> = vec![[None; 2]; edges.len()];
    for node in nodes_of(edges) {
        let ends: Vec<(usize, usize)> = node
            .into_iter()
            .filter(|(k, _)| edges[*k].ends[0] != edges[*k].ends[1] || edges[*k].length() < 2.0 * reach)
            .collect();
        let ways: Vec<DVec2> = ends.iter().map(|&(k, end)| edges[k].direction(end, reach)).collect();
        let mut pairs: Vec<(f64, usize, usize)> = Vec::new();
        for a in 0..ends.len() {
            for b in a + 1..ends.len() {
                if ends[a].0 != ends[b].0 {
                    pairs.push((ways[a].dot(ways[b]), a, b));
                }
            }
        }
        base::sort_by(&mut pairs, |a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
        let two = ends.len() == 2;
        let mut taken = vec![false; ends.len()];
        for (cos, a, b) in pairs {
            if !taken[a] && !taken[b] && (two || cos <= STRAIGHT_ON) {
                (taken[a], taken[b]) = (true, true);
                on[ends[a].0][ends[a].1] = Some(ends[b]);
                on[ends[b].0][ends[b].1] = Some(ends[a]);
            }
        }
    }
    let mut done: Vec<bool> = edges.iter().map(|e| e.gone).collect();
    let mut lines = Vec::new();
    // Paths that have an end first, then closed ones.
    for round in [false, true] {
        for k in 0..edges.len() {
            let start = (0..2).find(|&end| on[k][end].is_none());
            if done[k] || (start.is_none() && !round) {
                continue;
            }
            let mut line: Vec<DVec2> = Vec::new();
            let mut next = Some((k, start.unwrap_or_default()));
            while let Some((edge, end)) = next.filter(|(edge, _)| !done[*edge]) {
                done[edge] = true;
                let points = &edges[edge].points;
                let skip = usize::from(!line.is_empty());
                if end == 0 {
                    line.extend(points.iter().copied().skip(skip));
                } else {
                    line.extend(points.iter().rev().copied().skip(skip));
                }
                next = on[edge][1 - end];
            }
            lines.push(line);
        }
    }
    lines
}
