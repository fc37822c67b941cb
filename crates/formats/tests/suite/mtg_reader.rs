//! A reader of MTG text that shares nothing with the writer. It knows what digitised plants use: `^`, several entities
//! on a line, ranges (`E1<<E9`) and changes of scale.
#![allow(clippy::unwrap_used, clippy::panic, reason = "tests")]

use std::collections::BTreeMap;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Edge {
    Follows,
    Bears,
}

#[derive(Clone, Debug)]
pub(crate) struct Vertex {
    pub(crate) label: String,
    pub(crate) scale: usize,
    pub(crate) complex: Option<usize>,
    /// Within its scale.
    pub(crate) parent: Option<(usize, Edge)>,
    pub(crate) features: BTreeMap<String, String>,
}

#[derive(Debug, Default)]
pub(crate) struct Graph {
    pub(crate) vertices: Vec<Vertex>,
}

impl Graph {
    pub(crate) fn with_symbol<'a>(&'a self, symbol: &'a str) -> impl Iterator<Item = usize> + 'a {
        let letters = |l: &str| l.trim_end_matches(|c: char| c.is_ascii_digit()).to_owned();
        (0..self.vertices.len()).filter(move |&v| letters(&self.vertices[v].label) == symbol)
    }

    pub(crate) fn index(&self, v: usize) -> usize {
        self.vertices[v].label.trim_start_matches(|c: char| !c.is_ascii_digit()).parse().unwrap()
    }

    pub(crate) fn components(&self, complex: usize) -> impl Iterator<Item = usize> + '_ {
        (0..self.vertices.len()).filter(move |&v| self.vertices[v].complex == Some(complex))
    }

    pub(crate) fn word(&self, v: usize, name: &str) -> Option<&str> {
        self.vertices[v].features.get(name).map(String::as_str)
    }

    pub(crate) fn number(&self, v: usize, name: &str) -> Option<f64> {
        self.word(v, name)?.parse().ok()
    }
}

pub(crate) fn read(text: &str) -> Result<Graph, String> {
    let mut lines = text.lines().filter(|l| !l.trim().is_empty() && !l.trim_start().starts_with('#'));
    let code = lines.next().unwrap_or_default();
    if !code.starts_with("CODE") || !code.contains("FORM-A") {
        return Err(format!("no CODE: {code}"));
    }
    let mut scales = BTreeMap::new();
    let mut section = String::new();
    let mut head: Option<(usize, Vec<String>)> = None;
    let mut code =
        Code { graph: Graph::default(), scales: BTreeMap::new(), last: Vec::new(), coarse: BTreeMap::new() };
    for line in lines {
        let word = line.split_whitespace().next().unwrap_or_default();
        if let Some((columns, names)) = &head {
            code.line(line, *columns, names)?;
            continue;
        }
        match word.trim_end_matches(':') {
            name @ ("CLASSES" | "DESCRIPTION" | "FEATURES" | "MTG") if line.contains(':') => {
                section = name.into()
            }
            "ENTITY-CODE" => {
                let cells: Vec<&str> = line.split('\t').collect();
                let first = (1..cells.len()).find(|&i| !cells[i].trim().is_empty()).unwrap_or(cells.len());
                let names = cells[first..].iter().map(|n| n.trim().to_owned()).collect();
                head = Some((first, names));
                code.scales.clone_from(&scales);
            }
            symbol if section == "CLASSES" && symbol != "SYMBOL" => {
                let scale = line.split_whitespace().nth(1).and_then(|s| s.parse().ok());
                scales.insert(symbol.to_owned(), scale.ok_or_else(|| format!("no scale: {line}"))?);
            }
            _ => {}
        }
    }
    Ok(code.graph)
}

struct Code {
    graph: Graph,
    scales: BTreeMap<String, usize>,
    /// The last vertex of each column.
    last: Vec<Option<usize>>,
    /// For a vertex of a coarse scale that began at an edge: where that edge came from, for its first component.
    coarse: BTreeMap<usize, (usize, Edge)>,
}

impl Code {
    fn line(&mut self, line: &str, columns: usize, names: &[String]) -> Result<(), String> {
        let cells: Vec<&str> = line.split('\t').collect();
        let column = cells.iter().position(|c| !c.trim().is_empty()).unwrap_or(0);
        let text = cells[column].trim();
        let (continues, text) = text.strip_prefix('^').map_or((false, text), |t| (true, t));
        let from = if continues { column + 1 } else { column };
        let mut at = self.last.iter().take(from).rev().find_map(|v| *v);
        for (edge, label) in tokens(text)? {
            at = Some(self.add(at, &edge, &label)?);
        }
        let vertex = at.ok_or_else(|| format!("no entity: {line}"))?;
        for (name, value) in names.iter().zip(cells.iter().skip(columns)) {
            if !value.trim().is_empty() {
                self.graph.vertices[vertex].features.insert(name.clone(), value.trim().to_owned());
            }
        }
        self.last.resize(column + 1, None);
        self.last[column] = Some(vertex);
        Ok(())
    }

    fn add(&mut self, at: Option<usize>, edge: &str, label: &str) -> Result<usize, String> {
        let symbol = label.trim_end_matches(|c: char| c.is_ascii_digit());
        let scale = *self.scales.get(symbol).ok_or_else(|| format!("unknown symbol {symbol}"))?;
        if edge == "<<" {
            // A range: everything between the last index and this one.
            let number = |l: &str| l.trim_start_matches(|c: char| !c.is_ascii_digit()).parse::<usize>();
            let from = at.map(|v| number(&self.graph.vertices[v].label)).ok_or("a range without a start")?;
            let (from, to) = (from.map_err(|e| e.to_string())?, number(label).map_err(|e| e.to_string())?);
            let mut at = at;
            for i in from + 1..=to {
                at = Some(self.add(at, "<", &format!("{symbol}{i}"))?);
            }
            return at.ok_or_else(|| "an empty range".into());
        }
        let up_to = |mut v: usize, scale: usize, g: &Graph| {
            while g.vertices[v].scale > scale {
                v = g.vertices[v].complex?;
            }
            Some(v)
        };
        let id = self.graph.vertices.len();
        let (complex, parent) = if edge == "/" {
            let complex = at.and_then(|v| up_to(v, scale - 1, &self.graph));
            let parent = complex
                .filter(|c| !self.graph.vertices.iter().any(|v| v.complex == Some(*c) && v.scale == scale));
            (complex, parent.and_then(|c| self.coarse.get(&c).copied()))
        } else {
            let kind = if edge == "+" { Edge::Bears } else { Edge::Follows };
            let v = at.ok_or_else(|| format!("{edge}{label} follows nothing"))?;
            let same = up_to(v, scale, &self.graph).ok_or_else(|| format!("{label}: no such scale"))?;
            if same != v {
                self.coarse.insert(id, (v, kind));
            }
            (self.graph.vertices[same].complex, Some((same, kind)))
        };
        let vertex = Vertex { label: label.to_owned(), scale, complex, parent, features: BTreeMap::new() };
        self.graph.vertices.push(vertex);
        Ok(id)
    }
}

/// `^/E1<<E35` without its `^` -> `("/", "E1"), ("<<", "E35")`.
fn tokens(text: &str) -> Result<Vec<(String, String)>, String> {
    let mut out: Vec<(String, String)> = Vec::new();
    let mut rest = text;
    while !rest.is_empty() {
        let edges = rest.len() - rest.trim_start_matches(['/', '+', '<']).len();
        let (edge, tail) = rest.split_at(edges);
        let end = tail.find(['/', '+', '<']).unwrap_or(tail.len());
        let (label, tail) = tail.split_at(end);
        if edge.is_empty() || label.is_empty() {
            return Err(format!("not a code: {text}"));
        }
        out.push((edge.to_owned(), label.trim().to_owned()));
        rest = tail;
    }
    Ok(out)
}
