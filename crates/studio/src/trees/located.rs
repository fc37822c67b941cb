//! Text that people wrote, as a tree whose nodes know where they stand: `TOML | JSON value -> Node -> spec`.
//!
//! Both forms are read through this one reader: every further one would be a copy of the code that reads specs, which
//! is a good part of what a browser downloads.

use core::cell::Cell;

use serde::de::value::{BorrowedStrDeserializer, MapAccessDeserializer};
use serde::de::{
    DeserializeOwned, DeserializeSeed, Deserializer, Error as _, MapAccess, SeqAccess, Unexpected, Visitor,
};
use serde_json::Error;
use toml::de::{DeTable, DeValue};

/// A value and the byte of the text where it starts; 0 where there is no text.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Node {
    /// What is there.
    pub(super) kind: Kind,
    /// Byte of the text.
    pub(super) at: usize,
}

/// What a node holds.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Kind {
    Nothing,
    Truth(bool),
    Whole(i64),
    /// Above the largest `i64`.
    Large(u64),
    Number(f64),
    Text(String),
    List(Vec<Node>),
    Table(Vec<Entry>),
}

/// A row of a table.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Entry {
    /// Its name.
    pub(super) key: String,
    /// Byte of the text where the name starts.
    pub(super) at: usize,
    /// Its value.
    pub(super) node: Node,
}

/// What is wrong, and the byte of the text where.
#[derive(Debug)]
pub(super) struct Fault {
    /// In words.
    pub(super) message: String,
    /// Byte of the text.
    pub(super) at: usize,
}

impl Node {
    /// Of a TOML file. Depth is bounded by TOML's own reader.
    ///
    /// # Errors
    /// [`Fault`] for what is no TOML, for dates, and for numbers that have no room.
    pub(super) fn from_toml(text: &str) -> Result<Self, Fault> {
        let parsed = DeTable::parse(text).map_err(|e| Fault {
            message: e.message().lines().next().unwrap_or_default().trim().to_owned(),
            at: e.span().map_or(0, |s| s.start),
        })?;
        let at = parsed.span().start;
        Ok(Self { kind: Kind::of_table(parsed.get_ref())?, at })
    }

    /// Of a JSON value.
    pub(super) fn from_json(value: &serde_json::Value) -> Self {
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

    fn of_toml(value: &toml::Spanned<DeValue<'_>>) -> Result<Self, Fault> {
        let at = value.span().start;
        let fault = |message: &str| Fault { message: message.to_owned(), at };
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
            DeValue::Array(all) => Kind::List(all.iter().map(Self::of_toml).collect::<Result<_, _>>()?),
            DeValue::Table(table) => Kind::of_table(table)?,
        };
        Ok(Self { kind, at })
    }

    /// Reads what the tree describes.
    ///
    /// # Errors
    /// What is wrong, and the byte of the innermost node that is known to hold it. Inside of tables that say by a tag
    /// what they are, that is the table.
    pub(super) fn read<T: DeserializeOwned>(&self) -> Result<T, (Error, usize)> {
        let place = Cell::new(None);
        T::deserialize(Reader { node: self, place: &place }).map_err(|e| (e, place.get().unwrap_or(0)))
    }
}

impl Kind {
    /// As messages name it.
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

    fn of_table(table: &DeTable<'_>) -> Result<Self, Fault> {
        let entry = |(key, value): (&toml::Spanned<toml::de::DeString<'_>>, _)| {
            let (at, key) = (key.span().start, key.get_ref().to_string());
            Node::of_toml(value).map(|node| Entry { key, at, node })
        };
        table.iter().map(entry).collect::<Result<_, _>>().map(Self::Table)
    }
}

/// Serde's view of a node; `place` is that of the first fault.
#[derive(Clone, Copy)]
struct Reader<'a> {
    node: &'a Node,
    place: &'a Cell<Option<usize>>,
}

impl Reader<'_> {
    /// Keeps where it went wrong, unless something further in did.
    fn placed<T>(self, result: Result<T, Error>) -> Result<T, Error> {
        if result.is_err() {
            self.place.set(self.place.get().or(Some(self.node.at)));
        }
        result
    }
}

impl<'de> Deserializer<'de> for Reader<'de> {
    type Error = Error;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        let result = match &self.node.kind {
            Kind::Nothing => visitor.visit_unit(),
            Kind::Truth(truth) => visitor.visit_bool(*truth),
            Kind::Whole(whole) => visitor.visit_i64(*whole),
            Kind::Large(large) => visitor.visit_u64(*large),
            Kind::Number(number) => visitor.visit_f64(*number),
            Kind::Text(text) => visitor.visit_borrowed_str(text),
            Kind::List(all) => {
                let mut rest = Items { rest: all, place: self.place };
                visitor.visit_seq(&mut rest).and_then(|value| {
                    let all_read = rest.rest.is_empty();
                    let too_long = || Error::invalid_length(all.len(), &"fewer elements in array");
                    if all_read { Ok(value) } else { Err(too_long()) }
                })
            }
            Kind::Table(all) => visitor.visit_map(Entries { rest: all, place: self.place }),
        };
        self.placed(result)
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        let result =
            if self.node.kind == Kind::Nothing { visitor.visit_none() } else { visitor.visit_some(self) };
        self.placed(result)
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        _name: &'static str,
        visitor: V,
    ) -> Result<V::Value, Error> {
        self.placed(visitor.visit_newtype_struct(self))
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _name: &'static str,
        _variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        let result = match &self.node.kind {
            Kind::Text(text) => visitor.visit_enum(BorrowedStrDeserializer::new(text)),
            Kind::Table(all) => {
                let entries = Entries { rest: all, place: self.place };
                visitor.visit_enum(MapAccessDeserializer::new(entries))
            }
            other => Err(Error::invalid_type(other.found(), &"a word, or a table with one")),
        };
        self.placed(result)
    }

    serde::forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf unit unit_struct seq tuple
        tuple_struct map struct identifier ignored_any
    }
}

struct Items<'a> {
    rest: &'a [Node],
    place: &'a Cell<Option<usize>>,
}

impl<'de> SeqAccess<'de> for &mut Items<'de> {
    type Error = Error;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, Error> {
        let Some((node, rest)) = self.rest.split_first() else { return Ok(None) };
        self.rest = rest;
        let reader = Reader { node, place: self.place };
        reader.placed(seed.deserialize(reader)).map(Some)
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.rest.len())
    }
}

struct Entries<'a> {
    rest: &'a [Entry],
    place: &'a Cell<Option<usize>>,
}

impl<'de> MapAccess<'de> for Entries<'de> {
    type Error = Error;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, Error> {
        let Some(entry) = self.rest.first() else { return Ok(None) };
        let key = seed.deserialize(BorrowedStrDeserializer::new(&entry.key));
        if key.is_err() {
            self.place.set(self.place.get().or(Some(entry.at)));
        }
        key.map(Some)
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, Error> {
        let Some((entry, rest)) = self.rest.split_first() else {
            return Err(Error::custom("a value without a key"));
        };
        self.rest = rest;
        // Some look at a value after it was read: what they say is of this place too.
        let reader = Reader { node: &entry.node, place: self.place };
        reader.placed(seed.deserialize(reader))
    }
}
