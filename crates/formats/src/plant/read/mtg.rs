//! MTG text (FORM-A; Godin and Caraglio 1998) -> joints and organs.

use std::collections::BTreeMap;

use base::{Report, UpAxis};
use glam::DVec3;
use plant::{AxisKind, Frame, OrganKind};

use super::joints::{Built, Joint, Link, build};
use super::organs::{Found, Shapes};
use super::{Fault, Inward, LIMITS, StructureSpec, fault_at, place_of, said_in};
use crate::error::FileFault;

/// Names of the features of coordinates, in lower case, the preferred first.
const PLACE: [[&str; 3]; 3] = [["xx", "x", "coordx"], ["yy", "y", "coordy"], ["zz", "z", "coordz"]];
/// Names of the feature of the diameter at a node.
const DIAMETER: [&str; 4] = ["topdia", "diameter", "diam", "topdiameter"];
/// Names of the feature of the diameter at an axis's base.
const BASE_DIAMETER: [&str; 2] = ["botdia", "basdia"];
/// Names of the feature of the radius.
const RADIUS: [&str; 1] = ["radius"];

/// Symbols of digitised roses and trees whose chains of lone points are the margins of blades: leaflets (F), bracts
/// (L), stipules (Y), sepals (K).
const MARGINS: [&str; 4] = ["F", "L", "Y", "K"];
/// Number of points of a margin, without its bearer.
const MARGIN_POINTS: core::ops::RangeInclusive<usize> = 3..=4;

/// Relation of a vertex to the one from which it is declared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Edge {
    /// `/`: it is a part of that vertex.
    Part,
    /// `<`
    Follows,
    /// `+`
    Branches,
}

/// A vertex of the graph.
struct Vertex {
    symbol: usize,
    scale: i32,
    edge: Edge,
    /// The vertex from which it is declared, if not as a part.
    hung_on: Option<usize>,
    /// The vertex of which it is a part.
    whole: Option<usize>,
    row: Option<Row>,
    line: usize,
}

/// Features of a vertex.
struct Row {
    place: Option<DVec3>,
    radius: Option<f64>,
    base_radius: Option<f64>,
    /// Features that only our own files have.
    own: Option<OwnRow>,
}

struct OwnRow {
    kind: String,
    along: Option<DVec3>,
    normal: Option<DVec3>,
    length: Option<f64>,
    area: Option<f64>,
}

/// Reads an MTG.
pub(super) fn read(text: &str, spec: &StructureSpec, report: &mut Report) -> Result<Built, Fault> {
    let graph = Graph::read(text)?;
    if !graph.vertices.iter().any(|v| v.row.as_ref().is_some_and(|r| r.place.is_some())) {
        let advice = "the plant cannot be drawn from lengths and angles alone: export it with its geometry, as an OPF or with \
                      the features XX, YY, ZZ";
        return Err(fault_at(0, "none of its vertices has a place (XX, YY, ZZ)", advice));
    }
    let inward = Inward::new(spec, graph.said);
    let margins = graph.margins();
    let places = Places::new(&graph, &inward, &margins);
    let mut built = build(&places.joints)?;
    let mut shapes: BTreeMap<usize, Shapes> = BTreeMap::new();
    let mut added = 0_u64;
    let mut add = |built: &mut Built, joint: Option<usize>, mut found: Found| {
        let at = joint.and_then(|j| built.nodes[j]);
        // An organ without a bearer goes to the first plant.
        let (plant, node) = at.map_or((0, None), |(plant, node)| (plant, Some(node)));
        found.bearer = node;
        let Some(plant_of) = built.plants.get_mut(plant) else { return };
        added += u64::from(shapes.entry(plant).or_default().add(plant_of, &found));
    };
    for (v, joint, kind) in &places.organs {
        if let Some(found) = graph.own_organ(*v, *kind, &inward) {
            add(&mut built, *joint, found);
        }
    }
    for margin in &margins {
        let joint = places.joint_of[margin.bearer].map(|(j, _)| j);
        if let Some(found) = graph.blade(margin, joint.map(|j| places.joints[j].at), &inward) {
            add(&mut built, joint, found);
        }
    }
    if added > 0 {
        base::warn!(
            report,
            "organs-plain",
            { organs = added },
            "{organs} organs have plain shapes of the length and area that the file says: it has no outlines"
        );
    }
    built.tally.entries = graph.vertices.len() as u64;
    let nodes = built.nodes.iter().filter(|n| n.is_some()).count() as u64;
    // All points of a margin are used in its blade.
    let around: u64 = margins.iter().map(|m| m.points.len() as u64 - 1).sum();
    built.tally.used = (nodes + added + around).min(built.tally.entries);
    built.tally.unit_said = graph.said.0.is_some();
    Ok(built)
}

/// A chain of points around a blade.
struct Margin {
    bearer: usize,
    points: Vec<usize>,
    kind: OrganKind,
}

#[derive(Default)]
struct Graph {
    vertices: Vec<Vertex>,
    symbols: Vec<String>,
    /// The number of each symbol.
    known: BTreeMap<String, usize>,
    said: (Option<f64>, Option<UpAxis>),
}

/// Sections of such a file.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Section {
    Head,
    Classes,
    Other,
    Graph,
}

/// Columns of the code and the features.
struct Columns {
    /// Number of columns of the code.
    codes: usize,
    names: Vec<String>,
}

impl Columns {
    fn read(line: &str) -> Self {
        let cells: Vec<String> = line.split('\t').map(|c| c.trim().to_ascii_lowercase()).collect();
        let codes = (1..cells.len()).find(|&k| !cells[k].is_empty()).unwrap_or(cells.len());
        Self { codes, names: cells }
    }

    fn find(&self, names: &[&str]) -> Option<usize> {
        names
            .iter()
            .find_map(|n| self.names.iter().skip(self.codes).position(|c| c == n))
            .map(|k| k + self.codes)
    }
}

/// Columns of the features that are read.
struct Features {
    place: [Option<usize>; 3],
    diameter: Option<usize>,
    base_diameter: Option<usize>,
    radius: Option<usize>,
    kind: Option<usize>,
    along: [Option<usize>; 3],
    normal: [Option<usize>; 3],
    length: Option<usize>,
    area: Option<usize>,
}

impl Features {
    fn new(columns: &Columns) -> Self {
        let three = |names: [&str; 3]| names.map(|n| columns.find(&[n]));
        Self {
            place: [0, 1, 2].map(|k| columns.find(&PLACE[k])),
            diameter: columns.find(&DIAMETER),
            base_diameter: columns.find(&BASE_DIAMETER),
            radius: columns.find(&RADIUS),
            kind: columns.find(&["kind"]),
            along: three(["dx", "dy", "dz"]),
            normal: three(["nx", "ny", "nz"]),
            length: columns.find(&["length"]),
            area: columns.find(&["area"]),
        }
    }

    fn row(&self, cells: &[&str]) -> Row {
        let word = |column: Option<usize>| column.and_then(|k| cells.get(k)).map(|c| c.trim());
        let number = |column| word(column).and_then(|w| w.replacen(',', ".", 1).parse::<f64>().ok());
        let three = |columns: [Option<usize>; 3]| place_of(columns.map(number));
        let radius = number(self.radius).or_else(|| number(self.diameter).map(|d| 0.5 * d));
        let own = self.kind.filter(|_| self.along[0].is_some()).map(|kind| OwnRow {
            kind: word(Some(kind)).unwrap_or_default().to_owned(),
            along: three(self.along),
            normal: three(self.normal),
            length: number(self.length),
            area: number(self.area),
        });
        let base_radius = number(self.base_diameter).map(|d| 0.5 * d);
        Row { place: three(self.place), radius, base_radius, own }
    }
}

impl Graph {
    fn read(text: &str) -> Result<Self, Fault> {
        let mut graph = Self::default();
        let mut section = Section::Head;
        let mut scales: BTreeMap<String, i32> = BTreeMap::new();
        let mut head: Option<(Columns, Features)> = None;
        // The vertex with which each column of the code ended.
        let mut last: Vec<usize> = Vec::new();
        for (k, line) in text.lines().enumerate() {
            let bare = line.trim();
            if let Some(comment) = bare.strip_prefix('#') {
                let (unit, up) = said_in(comment);
                graph.said = (graph.said.0.or(unit), graph.said.1.or(up));
                continue;
            }
            if bare.is_empty() {
                continue;
            }
            let word = bare.split(':').next().unwrap_or("").trim().to_ascii_uppercase();
            let begins = match &*word {
                _ if !bare.contains(':') || section == Section::Graph => None,
                "CODE" => Some(Section::Head),
                "CLASSES" => Some(Section::Classes),
                "DESCRIPTION" | "FEATURES" => Some(Section::Other),
                "MTG" => Some(Section::Graph),
                _ => None,
            };
            if let Some(begun) = begins {
                section = begun;
                continue;
            }
            match section {
                Section::Head | Section::Other => {}
                Section::Classes => {
                    let mut cells = bare.split_whitespace();
                    if let (Some(symbol), Some(Ok(scale))) = (cells.next(), cells.next().map(str::parse)) {
                        scales.insert(symbol.to_owned(), scale);
                    }
                }
                Section::Graph => match &head {
                    None => {
                        let columns = Columns::read(line);
                        let features = Features::new(&columns);
                        head = Some((columns, features));
                    }
                    Some(head) => graph.line(line, k + 1, head, &scales, &mut last)?,
                },
            }
        }
        if graph.vertices.is_empty() {
            let advice =
                "after the line `MTG:` and a line of names (ENTITY-CODE) comes a line for each entity";
            return Err(fault_at(0, "there is no entity in it", advice));
        }
        Ok(graph)
    }

    /// Reads a line of the graph: the path to one vertex, and its features.
    fn line(
        &mut self,
        line: &str,
        number: usize,
        (columns, features): &(Columns, Features),
        scales: &BTreeMap<String, i32>,
        last: &mut Vec<usize>,
    ) -> Result<(), Fault> {
        let cells: Vec<&str> = line.split('\t').collect();
        let Some(column) = (0..columns.codes.min(cells.len())).find(|&c| !cells[c].trim().is_empty()) else {
            return Ok(());
        };
        let code = cells[column].trim();
        let goes_on = code.starts_with('^');
        let from = if goes_on { last.get(column) } else { column.checked_sub(1).and_then(|c| last.get(c)) };
        if from.is_none() && (goes_on || column > 0) {
            let advice = "an entity stands one column right of the one that it belongs to, or below the one that `^` goes on with";
            return Err(fault_at(number, format!("`{code}` stands below nothing"), advice));
        }
        let mut at = from.copied();
        for step in Step::parse(code.trim_start_matches('^'), number)? {
            at = Some(self.step(&step, at, scales, number)?);
        }
        let Some(at) = at else { return Ok(()) };
        // A line without a further step only gives more features of that vertex.
        self.vertices[at].row = Some(features.row(&cells));
        // Columns that were left out have the same vertex.
        last.truncate(column);
        last.resize(column, at);
        last.push(at);
        Ok(())
    }

    /// Returns the vertex to which a step of a path leads.
    fn step(
        &mut self,
        step: &Step<'_>,
        from: Option<usize>,
        scales: &BTreeMap<String, i32>,
        line: usize,
    ) -> Result<usize, Fault> {
        let known = scales.get(step.symbol).copied();
        // A class that is not declared has the scale of its predecessor, or one finer if it is a part of it.
        let scale = known.unwrap_or_else(|| match (from, step.edge) {
            (None, _) => 0,
            (Some(f), Edge::Part) => self.vertices[f].scale + 1,
            (Some(f), _) => self.vertices[f].scale,
        });
        let mut base = from;
        let above = |v: &Vertex| if step.edge == Edge::Part { v.scale >= scale } else { v.scale > scale };
        while let Some(b) = base.filter(|&b| above(&self.vertices[b])) {
            base = self.vertices[b].whole;
        }
        let (hung_on, whole) = match step.edge {
            Edge::Part => (None, base),
            _ => (
                from,
                base.and_then(
                    |b| if self.vertices[b].scale == scale { self.vertices[b].whole } else { Some(b) },
                ),
            ),
        };
        if self.vertices.len() >= LIMITS.joints {
            let (what, advice) = ("the number of entities", "split the file");
            return Err((line, FileFault::TooMuch { what, limit: LIMITS.joints as u64, advice }));
        }
        let symbol = self.known.get(step.symbol).copied().unwrap_or_else(|| {
            self.symbols.push(step.symbol.to_owned());
            self.known.insert(step.symbol.to_owned(), self.symbols.len() - 1);
            self.symbols.len() - 1
        });
        self.vertices.push(Vertex { symbol, scale, edge: step.edge, hung_on, whole, row: None, line });
        Ok(self.vertices.len() - 1)
    }

    fn symbol(&self, v: usize) -> &str {
        &self.symbols[self.vertices[v].symbol]
    }

    fn place(&self, v: usize) -> Option<DVec3> {
        self.vertices[v].row.as_ref()?.place
    }

    /// Returns the chains of points that are margins: three or four of one symbol, the first borne, without thickness
    /// and bearing nothing.
    fn margins(&self) -> Vec<Margin> {
        let mut next: Vec<Option<usize>> = vec![None; self.vertices.len()];
        let mut is_bearing = vec![false; self.vertices.len()];
        for (v, vertex) in self.vertices.iter().enumerate() {
            let Some(on) = vertex.hung_on else { continue };
            let same = self.vertices[on].symbol == vertex.symbol && vertex.edge == Edge::Follows;
            if same && next[on].is_none() { next[on] = Some(v) } else { is_bearing[on] = true }
        }
        let is_point = |v: usize| {
            let row = self.vertices[v].row.as_ref();
            !is_bearing[v] && row.is_some_and(|r| r.place.is_some() && r.radius.is_none() && r.own.is_none())
        };
        let mut out = Vec::new();
        for (first, vertex) in self.vertices.iter().enumerate() {
            let Some(bearer) = vertex.hung_on.filter(|_| vertex.edge == Edge::Branches) else { continue };
            let symbol = self.symbol(first);
            if !MARGINS.contains(&symbol) || self.place(bearer).is_none() {
                continue;
            }
            let chain = core::iter::successors(Some(first), |&v| next[v]).take(MARGIN_POINTS.end() + 1);
            let points: Vec<usize> = chain.collect();
            if MARGIN_POINTS.contains(&points.len()) && points.iter().all(|&v| is_point(v)) {
                let kind = if symbol == "K" { OrganKind::Sepal } else { OrganKind::Leaf };
                out.push(Margin { bearer, points, kind });
            }
        }
        out
    }

    /// Returns a blade through the points of its margin, from the place of its bearer.
    fn blade(&self, margin: &Margin, root: Option<DVec3>, inward: &Inward) -> Option<Found> {
        let root = root?;
        let rim: Option<Vec<DVec3>> =
            margin.points.iter().map(|&v| self.place(v).map(|p| inward.place(p))).collect();
        let rim = rim?;
        let tip = *rim.iter().max_by(|a, b| a.distance(root).total_cmp(&b.distance(root)))?;
        let along = tip - root;
        // The polygon's area as a vector (Newell).
        let around: Vec<DVec3> = core::iter::once(root).chain(rim).collect();
        let pairs = around.iter().zip(around.iter().cycle().skip(1));
        let area = pairs.map(|(a, b)| (a - root).cross(b - root)).sum::<DVec3>() * 0.5;
        let up = if area.y < 0.0 { -area } else { area };
        Some(Found {
            kind: margin.kind,
            bearer: None,
            frame: Frame::looking(root, along, up),
            length_m: Some(along.length()),
            area_m2: Some(area.length()),
            key: margin.points[0] as u64,
        })
    }

    /// Returns an organ of our own files.
    fn own_organ(&self, v: usize, kind: OrganKind, inward: &Inward) -> Option<Found> {
        let row = self.vertices[v].row.as_ref()?;
        let own = row.own.as_ref()?;
        let turned = |v: Option<DVec3>| v.map_or(DVec3::ZERO, |v| inward.turn(v));
        let square = inward.metres * inward.metres;
        Some(Found {
            kind,
            bearer: None,
            frame: Frame::looking(inward.place(row.place?), turned(own.along), turned(own.normal)),
            length_m: own.length.map(|l| l * inward.metres),
            area_m2: own.area.map(|a| a * square),
            key: v as u64,
        })
    }
}

/// Returns the kind of organ of one of our words.
fn organ_of(word: &str) -> Option<OrganKind> {
    Some(match word {
        "leaf" => OrganKind::Leaf,
        "petal" => OrganKind::Petal,
        "disc" => OrganKind::Disc,
        "fruit" => OrganKind::Fruit,
        "stamen" => OrganKind::Stamen,
        "pistil" => OrganKind::Pistil,
        "sepal" => OrganKind::Sepal,
        "anther" => OrganKind::Anther,
        "floret" => OrganKind::Floret,
        "body" => OrganKind::Body,
        "pot" => OrganKind::Pot,
        "thorn" => OrganKind::Thorn,
        "pedicel" => OrganKind::Pedicel,
        _ => return None,
    })
}

fn axis_of(word: &str) -> Option<AxisKind> {
    Some(match word {
        "trunk" | "branch" => AxisKind::Branch,
        "twig" => AxisKind::Twig,
        "stem" => AxisKind::Stem,
        "petiole" => AxisKind::Petiole,
        "root" => AxisKind::Root,
        "stub" => AxisKind::Stub,
        _ => return None,
    })
}

/// The joints of a graph, and the places of its vertices.
struct Places {
    joints: Vec<Joint>,
    /// The joint of each vertex, or, if it has no place of its own, the joint on which it hangs; and the link of its
    /// successor there.
    joint_of: Vec<Option<(usize, Link)>>,
    /// Organs of our own files: vertex, the joint that bears it, and kind.
    organs: Vec<(usize, Option<usize>, OrganKind)>,
}

impl Places {
    fn new(graph: &Graph, inward: &Inward, margins: &[Margin]) -> Self {
        let count = graph.vertices.len();
        let mut is_margin = vec![false; count];
        margins.iter().flat_map(|m| &m.points).for_each(|&v| is_margin[v] = true);
        let mut out = Self { joints: Vec::new(), joint_of: vec![None; count], organs: Vec::new() };
        // For each vertex: whether a part of it has a place; its plant; the kind of its axes.
        let mut has_part = vec![false; count];
        let mut plant: Vec<usize> = (0..count).collect();
        let mut kind: Vec<Option<AxisKind>> = vec![None; count];
        for (v, vertex) in graph.vertices.iter().enumerate() {
            // A predecessor comes earlier in the file.
            if let Some(from) = vertex.hung_on.or(vertex.whole.filter(|&w| graph.vertices[w].scale > 0)) {
                plant[v] = plant[from];
            }
            let own = vertex.row.as_ref().and_then(|r| r.own.as_ref());
            kind[v] = own.and_then(|o| axis_of(&o.kind)).or_else(|| vertex.whole.and_then(|w| kind[w]));
            let anchor = match (vertex.hung_on, vertex.whole) {
                (Some(on), _) => out.joint_of[on].map(|(j, before)| {
                    let branches = vertex.edge == Edge::Branches
                        || (before == Link::Branches && graph.place(on).is_none());
                    (j, if branches { Link::Branches } else { Link::Follows })
                }),
                (None, Some(whole)) => out.joint_of[whole].map(|(j, before)| match graph.place(whole) {
                    Some(_) => (j, if has_part[whole] { Link::Branches } else { Link::Follows }),
                    None => (j, before),
                }),
                (None, None) => None,
            };
            if let Some(organ) = own.and_then(|o| organ_of(&o.kind)) {
                out.organs.push((v, anchor.map(|a| a.0), organ));
                continue;
            }
            let row = vertex.row.as_ref().filter(|_| !is_margin[v]);
            let Some((row, place)) = row.and_then(|r| Some((r, r.place?))) else {
                out.joint_of[v] = anchor;
                continue;
            };
            let link = anchor.map_or(Link::Unsaid, |a| a.1);
            let joint = Joint {
                radius: inward.radius(row.radius),
                base_radius: inward.radius(row.base_radius),
                kind: kind[v].unwrap_or(AxisKind::Branch),
                plant: Some(plant[v]),
                ..Joint::new(inward.place(place), anchor.map(|a| a.0), link, vertex.line)
            };
            out.joints.push(joint);
            out.joint_of[v] = Some((out.joints.len() - 1, Link::Follows));
            if let Some(whole) = vertex.whole {
                has_part[whole] = true;
            }
        }
        out
    }
}

/// A step of a path, such as `+A1`; a range (`/E1<<E5`) has a first and a last step.
struct Step<'a> {
    edge: Edge,
    symbol: &'a str,
}

impl<'a> Step<'a> {
    fn parse(code: &'a str, line: usize) -> Result<Vec<Self>, Fault> {
        let advice = "a code is made of /, < and +, each with a class and a number: /P1/A1+L2";
        let wrong = || fault_at(line, format!("`{code}` is no code of an entity"), advice);
        let mut out = Vec::new();
        let mut rest = code;
        while !rest.is_empty() {
            let signs = rest.find(|c: char| !"/<+.".contains(c)).ok_or_else(wrong)?;
            let (sign, after) = rest.split_at(signs);
            let edge = match sign.chars().next() {
                Some('/') => Edge::Part,
                Some('<') => Edge::Follows,
                Some('+') => Edge::Branches,
                _ => return Err(wrong()),
            };
            let end = after.find(['/', '<', '+']).unwrap_or(after.len());
            let (label, behind) = after.split_at(end);
            let symbol = label.trim_end_matches(|c: char| c.is_ascii_digit() || c == '-');
            if symbol.is_empty() || symbol.contains(char::is_whitespace) {
                return Err(wrong());
            }
            out.push(Self { edge, symbol });
            rest = behind;
        }
        Ok(out)
    }
}
