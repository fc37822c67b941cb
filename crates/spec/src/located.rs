//! Text that people wrote, as a tree whose nodes know where they stand: `TOML | JSON value -> Node -> spec`.
//!
//! Both forms are read through this one reader: a second reader would be another copy of the code that reads specs,
//! which is a good part of what a browser downloads.

use serde::de::value::{BorrowedStrDeserializer, MapAccessDeserializer};
use serde::de::{
    DeserializeOwned, DeserializeSeed, Deserializer, Error as _, MapAccess, SeqAccess, Unexpected, Visitor,
};
use serde_json::Error;
use toml::de::{DeTable, DeValue};

/// A value and the byte of the text where it starts; 0 where there is no text.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// The value itself.
    pub kind: Kind,
    /// Byte of the text.
    pub at: usize,
}

/// The value of a node.
#[derive(Clone, Debug, PartialEq)]
pub enum Kind {
    /// JSON's `null`.
    Nothing,
    /// `true` or `false`.
    Truth(bool),
    /// A whole number.
    Whole(i64),
    /// Above the largest `i64`.
    Large(u64),
    /// Any other number.
    Number(f64),
    /// A text.
    Text(String),
    /// Rows.
    List(Vec<Node>),
    /// Fields with their names, in the order of the text.
    Table(Vec<Entry>),
}

/// A row of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// Its name.
    pub key: String,
    /// Byte of the text where the name starts.
    pub at: usize,
    /// Its value.
    pub node: Node,
}

/// A fault in a text, with the byte at which it lies.
#[derive(Debug)]
pub struct TextFault {
    /// Names and rows that lead to it: `method.tropisms[1]`; empty for the whole.
    pub path: String,
    /// The fault in words.
    pub message: String,
    /// Byte of the text.
    pub at: usize,
}

impl Node {
    /// Reads a TOML file. TOML's own reader bounds the depth.
    ///
    /// # Errors
    /// [`TextFault`] for text that is not TOML, for dates, and for numbers that do not fit.
    pub fn from_toml(text: &str) -> Result<Self, TextFault> {
        let parsed = DeTable::parse(text).map_err(|e| TextFault {
            path: String::new(),
            message: e.message().lines().next().unwrap_or_default().trim().to_owned(),
            at: e.span().map_or(0, |s| s.start),
        })?;
        let at = parsed.span().start;
        Ok(Self { kind: Kind::from_table(parsed.get_ref())?, at })
    }

    /// Builds the tree of a JSON value.
    pub fn from_json(value: &serde_json::Value) -> Self {
        let kind = match value {
            serde_json::Value::Null => Kind::Nothing,
            serde_json::Value::Bool(truth) => Kind::Truth(*truth),
            serde_json::Value::Number(n) => match (n.as_i64(), n.as_u64()) {
                (Some(whole), _) => Kind::Whole(whole),
                (None, Some(large)) => Kind::Large(large),
                (None, None) => Kind::Number(n.as_f64().unwrap_or(f64::NAN)),
            },
            serde_json::Value::String(text) => Kind::Text(text.clone()),
            serde_json::Value::Array(all) => Kind::List(all.iter().map(Self::from_json).collect()),
            serde_json::Value::Object(fields) => {
                let entry = |(key, value): (&String, &serde_json::Value)| Entry {
                    key: key.clone(),
                    at: 0,
                    node: Self::from_json(value),
                };
                Kind::Table(fields.iter().map(entry).collect())
            }
        };
        Self { kind, at: 0 }
    }

    fn from_value(value: &toml::Spanned<DeValue<'_>>) -> Result<Self, TextFault> {
        let at = value.span().start;
        let fault = |message: &str| TextFault { path: String::new(), message: message.to_owned(), at };
        let kind = match value.get_ref() {
            DeValue::String(text) => Kind::Text(text.to_string()),
            DeValue::Integer(n) => match i64::from_str_radix(n.as_str(), n.radix()) {
                Ok(whole) => Kind::Whole(whole),
                Err(_large) => u64::from_str_radix(n.as_str(), n.radix())
                    .map(Kind::Large)
                    .map_err(|_larger| fault("integer number overflowed"))?,
            },
            DeValue::Float(n) => {
                let number = n.as_str().parse().ok();
                let number = number.filter(|x: &f64| x.is_finite() || n.as_str().contains(['i', 'n']));
                Kind::Number(number.ok_or_else(|| fault("floating-point number overflowed"))?)
            }
            DeValue::Boolean(truth) => Kind::Truth(*truth),
            DeValue::Datetime(_) => return Err(fault("a date has no place here")),
            DeValue::Array(all) => Kind::List(all.iter().map(Self::from_value).collect::<Result<_, _>>()?),
            DeValue::Table(table) => Kind::from_table(table)?,
        };
        Ok(Self { kind, at })
    }

    /// Reads the type that the tree describes.
    ///
    /// # Errors
    /// [`TextFault`] with the names of the fields that lead to the fault. Serde's own readers lose their place inside
    /// tables whose form is given by a tag, so the place is searched for by reading again without parts of the tree.
    pub fn read<T: DeserializeOwned>(&self) -> Result<T, TextFault> {
        T::deserialize(Reader { node: self }).map_err(|e| {
            let message = e.to_string();
            let says = |tree: &Self| T::deserialize(Reader { node: tree }).err().map(|e| e.to_string());
            let (path, at) = self.culprit(&message, &says);
            TextFault { path, message: base::brief(&message), at }
        })
    }

    /// Returns the names and the place of the innermost faulty node; `says` returns the reader's message for a tree.
    fn culprit(&self, message: &str, says: &dyn Fn(&Self) -> Option<String>) -> (String, usize) {
        let named = |what: &str| message.strip_prefix(what)?.strip_prefix(" field `")?.split('`').next();
        if let Some(name) = named("missing") {
            return self.lacks(name, message, says);
        }
        let unknown = named("unknown");
        let same = |tree: &Self| says(tree).as_deref() == Some(message);
        let mut tree = self.clone();
        let (mut route, mut path, mut at) = (Vec::new(), String::new(), self.at);
        loop {
            let Some(whole) = tree.on(&route).cloned() else { return (path, at) };
            let mut with = |m: usize| {
                tree.on(&route).into_iter().for_each(|node| *node = whole.first(m));
                let same = same(&tree);
                tree.on(&route).into_iter().for_each(|node| node.clone_from(&whole));
                same
            };
            let all = whole.parts();
            if all == 0 || with(0) {
                // A tag is kept throughout the search, so it is tried first.
                let tag = whole.entries().iter().find(|e| e.is_tag());
                return match tag.filter(|_| all > 0 && message.starts_with("unknown variant")) {
                    Some(tag) => (joined(&path, &tag.key), tag.at),
                    None => (path, at),
                };
            }
            // Finds the fewest leading parts that still show the fault: the last of them causes it.
            let (mut without, mut enough) = (0, all);
            while enough - without > 1 {
                let middle = usize::midpoint(without, enough);
                if with(middle) { enough = middle } else { without = middle }
            }
            match &whole.kind {
                Kind::Table(entries) => {
                    let entry = &entries[without];
                    if unknown == Some(&entry.key) {
                        return (path, entry.at);
                    }
                    (path, at) = (joined(&path, &entry.key), entry.node.at);
                }
                // A list that is too short or too long is at fault itself, not one of its numbers.
                Kind::List(nodes) if message.starts_with("invalid length") && nodes[without].parts() == 0 => {
                    return (path, at);
                }
                Kind::List(nodes) => {
                    path += &format!("[{without}]");
                    at = nodes[without].at;
                }
                _ => return (path, at),
            }
            route.push(without);
        }
    }

    /// Finds the table in which a field is missing.
    fn lacks(&self, name: &str, message: &str, says: &dyn Fn(&Self) -> Option<String>) -> (String, usize) {
        let mut tree = self.clone();
        let mut waiting: Vec<(Vec<usize>, String)> = vec![(Vec::new(), String::new())];
        while let Some((route, path)) = waiting.pop() {
            let Some(node) = tree.on(&route) else { continue };
            let at = node.at;
            if let Kind::Table(entries) = &mut node.kind {
                entries.push(Entry { key: name.to_owned(), at, node: Self { kind: Kind::Nothing, at } });
                // Where the field is missing, adding it gives another fault; elsewhere the field is unknown.
                let unknown = format!("unknown field `{name}`");
                if says(&tree).is_none_or(|now| now != message && !now.starts_with(&unknown)) {
                    return (path, at);
                }
                if let Some(Self { kind: Kind::Table(entries), .. }) = tree.on(&route) {
                    entries.pop();
                }
            }
            let Some(node) = tree.on(&route) else { continue };
            // Only lists of tables are searched: a mesh has millions of numbers.
            let tables = match &node.kind {
                Kind::List(all) => all.first().is_some_and(|n| matches!(n.kind, Kind::Table(_))),
                _ => true,
            };
            for k in (0..if tables { node.parts() } else { 0 }).rev() {
                let path = match &node.kind {
                    Kind::Table(entries) => joined(&path, &entries[k].key),
                    _ => format!("{path}[{k}]"),
                };
                waiting.push(([&route[..], &[k]].concat(), path));
            }
        }
        (String::new(), self.at)
    }

    /// Returns the node at the end of a route of part numbers.
    fn on(&mut self, route: &[usize]) -> Option<&mut Self> {
        route.iter().try_fold(self, |node, &k| match &mut node.kind {
            Kind::Table(entries) => entries.get_mut(k).map(|e| &mut e.node),
            Kind::List(nodes) => nodes.get_mut(k),
            _ => None,
        })
    }

    fn parts(&self) -> usize {
        if let Kind::List(nodes) = &self.kind { nodes.len() } else { self.entries().len() }
    }

    /// Returns the rows of a table; empty for any other node.
    pub fn entries(&self) -> &[Entry] {
        if let Kind::Table(entries) = &self.kind { entries } else { &[] }
    }

    /// Returns the value of a field of a table.
    pub fn field(&self, name: &str) -> Option<&Self> {
        self.entries().iter().find(|e| e.key == name).map(|e| &e.node)
    }

    /// Returns the node at a path such as `method.tropisms[1].strength`.
    pub fn at_path(&self, path: &str) -> Option<&Self> {
        path.split(['.', '[']).filter(|step| !step.is_empty()).try_fold(self, |node, step| {
            match (&node.kind, step.strip_suffix(']')) {
                (Kind::List(all), Some(row)) => all.get(row.parse::<usize>().ok()?),
                (_, None) => node.field(step),
                _ => None,
            }
        })
    }

    /// Returns the node with its first `m` parts and its tags only.
    fn first(&self, m: usize) -> Self {
        let kind = match &self.kind {
            Kind::Table(all) => {
                let kept = all.iter().enumerate().filter(|(k, e)| *k < m || e.is_tag());
                Kind::Table(kept.map(|(_, e)| e.clone()).collect())
            }
            Kind::List(all) => Kind::List(all[..m].to_vec()),
            other => other.clone(),
        };
        Self { kind, at: self.at }
    }
}

fn joined(path: &str, key: &str) -> String {
    if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") }
}

impl Entry {
    /// Whether the entry is a tag that gives the form of its table.
    fn is_tag(&self) -> bool {
        matches!(self.key.as_str(), "kind" | "shape")
    }
}

impl Kind {
    /// Returns the value as messages name it.
    fn found(&self) -> Unexpected<'_> {
        match self {
            Self::Nothing => Unexpected::Unit,
            Self::Truth(truth) => Unexpected::Bool(*truth),
            Self::Whole(whole) => Unexpected::Signed(*whole),
            Self::Large(large) => Unexpected::Unsigned(*large),
            Self::Number(number) => Unexpected::Float(*number),
            Self::Text(text) => Unexpected::Str(text),
            Self::List(_) => Unexpected::Seq,
            Self::Table(_) => Unexpected::Map,
        }
    }

    fn from_table(table: &DeTable<'_>) -> Result<Self, TextFault> {
        let entry = |(key, value): (&toml::Spanned<toml::de::DeString<'_>>, _)| {
            let (at, key) = (key.span().start, key.get_ref().to_string());
            Node::from_value(value).map(|node| Entry { key, at, node })
        };
        table.iter().map(entry).collect::<Result<_, _>>().map(Self::Table)
    }
}

/// Serde's view of a node.
#[derive(Clone, Copy)]
struct Reader<'a> {
    node: &'a Node,
}

impl<'de> Reader<'de> {
    fn list<V: Visitor<'de>>(self, all: &'de [Node], visitor: V) -> Result<V::Value, Error> {
        let mut rest = Items { rest: all };
        let value = visitor.visit_seq(&mut rest)?;
        if rest.rest.is_empty() {
            return Ok(value);
        }
        Err(Error::invalid_length(all.len(), &"fewer elements in array"))
    }
}

// Each method offers a visitor only the kinds of value that it accepts: offering all of them would compile all that
// code for each type.
impl<'de> Deserializer<'de> for Reader<'de> {
    type Error = Error;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match &self.node.kind {
            Kind::Nothing => visitor.visit_unit(),
            Kind::Truth(truth) => visitor.visit_bool(*truth),
            Kind::Whole(whole) => visitor.visit_i64(*whole),
            Kind::Large(large) => visitor.visit_u64(*large),
            Kind::Number(number) => visitor.visit_f64(*number),
            Kind::Text(text) => visitor.visit_borrowed_str(text),
            Kind::List(all) => self.list(all, visitor),
            Kind::Table(all) => visitor.visit_map(Entries { rest: all }),
        }
    }

    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match &self.node.kind {
            Kind::List(all) => self.list(all, visitor),
            other => Err(Error::invalid_type(other.found(), &visitor)),
        }
    }

    fn deserialize_tuple<V: Visitor<'de>>(self, _len: usize, visitor: V) -> Result<V::Value, Error> {
        self.deserialize_seq(visitor)
    }

    fn deserialize_map<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match &self.node.kind {
            Kind::Table(all) => visitor.visit_map(Entries { rest: all }),
            other => Err(Error::invalid_type(other.found(), &visitor)),
        }
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _name: &'static str,
        _fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        // Never reads a list of values without names, which nobody writes: that would double the code for each type.
        self.deserialize_map(visitor)
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        if self.node.kind == Kind::Nothing { visitor.visit_none() } else { visitor.visit_some(self) }
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        _name: &'static str,
        visitor: V,
    ) -> Result<V::Value, Error> {
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _name: &'static str,
        _variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        match &self.node.kind {
            Kind::Text(text) => visitor.visit_enum(BorrowedStrDeserializer::new(text)),
            Kind::Table(all) => {
                let entries = Entries { rest: all };
                visitor.visit_enum(MapAccessDeserializer::new(entries))
            }
            other => Err(Error::invalid_type(other.found(), &"a word, or a table with one")),
        }
    }

    serde::forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf unit unit_struct
        tuple_struct identifier ignored_any
    }
}

struct Items<'a> {
    rest: &'a [Node],
}

impl<'de> SeqAccess<'de> for &mut Items<'de> {
    type Error = Error;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, Error> {
        let Some((node, rest)) = self.rest.split_first() else { return Ok(None) };
        self.rest = rest;
        seed.deserialize(Reader { node }).map(Some)
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.rest.len())
    }
}

struct Entries<'a> {
    rest: &'a [Entry],
}

impl<'de> MapAccess<'de> for Entries<'de> {
    type Error = Error;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, Error> {
        let Some(entry) = self.rest.first() else { return Ok(None) };
        seed.deserialize(BorrowedStrDeserializer::new(&entry.key)).map(Some)
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, Error> {
        let Some((entry, rest)) = self.rest.split_first() else {
            return Err(Error::custom("a value without a key"));
        };
        self.rest = rest;
        seed.deserialize(Reader { node: &entry.node })
    }
}
