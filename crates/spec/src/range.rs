//! One check of ranges for all specs: `value + its schema -> the first number out of range`.
//!
//! Serde writes the value into a writer that keeps nothing: the writer only follows the schema down and checks numbers.
//! So a mesh of a million vertices costs no memory, and the spec is checked in the form of its file.

use core::fmt;

use serde::ser::{
    Serialize, SerializeMap, SerializeSeq, SerializeStruct, SerializeStructVariant, SerializeTuple,
    SerializeTupleStruct, SerializeTupleVariant, Serializer,
};
use serde_json::Value;

use crate::Spec;

/// A number of a spec that is out of its range, or not finite.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{path} must be {}, not {}", self.range(), short(*value))]
pub struct RangeFault {
    /// Names and rows that lead to it: `method.tropisms[1].strength`.
    pub path: String,
    /// The value found.
    pub value: f64,
    /// The least value allowed.
    pub least: Option<f64>,
    /// The largest value allowed.
    pub most: Option<f64>,
    /// The bound that the value must exceed.
    pub above: Option<f64>,
    /// Its unit; empty for none.
    pub unit: &'static str,
}

impl RangeFault {
    /// Returns the range in words: `0 to 2 m`.
    pub fn range(&self) -> String {
        let range = match (self.least, self.most, self.above) {
            (_, Some(most), Some(above)) => format!("above {} and at most {}", short(above), short(most)),
            (_, None, Some(above)) => format!("above {}", short(above)),
            (Some(least), Some(most), None) => format!("{} to {}", short(least), short(most)),
            (Some(least), None, None) => format!("{} or more", short(least)),
            (None, Some(most), None) => format!("at most {}", short(most)),
            (None, None, None) => "finite".into(),
        };
        if self.unit.is_empty() { range } else { format!("{range} {}", self.unit) }
    }
}

base::coded!(RangeFault {
    fault => "field-range" { field = fault.path, range = fault.range(), value = fault.value },
});

/// Formats large and small numbers as people write them.
fn short(x: f64) -> String {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "whole and below 1e15")]
    let whole = |x: f64| base::grouped(x.abs() as u64);
    match x {
        _ if x.fract() == 0.0 && (1e4..1e15).contains(&x.abs()) => {
            format!("{}{}", if x < 0.0 { "-" } else { "" }, whole(x))
        }
        _ if x != 0.0 && !(1e-4..1e15).contains(&x.abs()) => format!("{x:e}"),
        _ => x.to_string(),
    }
}

/// Fails on the first number that lies outside of the range that the schema gives it.
///
/// Checks `minimum`, `maximum` and `exclusiveMinimum`, through references, lists and tagged forms. Relations between
/// fields are not checked. Cost: linear in the numbers of the spec.
///
/// # Errors
/// [`RangeFault`] with the path, the value and the range.
pub fn check<T: Spec>(value: &T) -> Result<(), RangeFault> {
    let root = T::schema();
    let look = Look { root, at: root.pointer(T::PART), trail: &Trail::Root, tag: None };
    // Only a range fault stops the writer: it accepts everything else that serde writes.
    value.serialize(look).map(|_| ()).or_else(|Stop(fault)| fault.map_or(Ok(()), |f| Err(*f)))
}

/// Returns the least and the largest value that the schema allows in a field such as `leaf.fold`; `None` for a field
/// that does not exist or is not bounded on both sides.
///
/// ```
/// #[derive(Default, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
/// struct Pot {
///     #[schemars(range(min = 0.5, max = 2.0))]
///     height_m: Option<f64>,
/// }
/// spec::schemas!(Pot);
/// assert_eq!(spec::range::<Pot>("height_m"), Some([0.5, 2.0]));
/// assert_eq!(spec::range::<Pot>("width_m"), None);
/// ```
pub fn range<T: Spec>(path: &str) -> Option<[f64; 2]> {
    let root = T::schema();
    let field = |at, name| found(root, at, &|s: &'static Value| s.get("properties")?.get(name));
    let at = path.split('.').try_fold(root.pointer(T::PART)?, field)?;
    let limit = |name| found(root, at, &|s| s.get(name)?.as_f64());
    Some([limit("minimum")?, limit("maximum")?])
}

/// The path from the root to a value, kept on the stack.
enum Trail<'a> {
    Root,
    Field(&'a Self, &'a str),
    Row(&'a Self, usize),
}

impl fmt::Display for Trail<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Root => Ok(()),
            Self::Field(Self::Root, name) => f.write_str(name),
            Self::Field(up, name) => write!(f, "{up}.{name}"),
            Self::Row(up, row) => write!(f, "{up}[{row}]"),
        }
    }
}

/// Reason why the writer stopped.
#[derive(Debug)]
struct Stop(Option<Box<RangeFault>>);

impl fmt::Display for Stop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.as_ref().map_or(Ok(()), |fault| fault.fmt(f))
    }
}

impl std::error::Error for Stop {}

impl serde::ser::Error for Stop {
    fn custom<T: fmt::Display>(_message: T) -> Self {
        Self(None)
    }
}

/// Row of the variant whose tag was written.
type Variant = Option<usize>;

/// Checks one value.
#[derive(Clone, Copy)]
struct Look<'a> {
    root: &'static Value,
    /// Schema of the value; `None` where the schema says nothing.
    at: Option<&'static Value>,
    trail: &'a Trail<'a>,
    /// Key and forms, where the value is the tag of one of them.
    tag: Option<(&'static str, &'static [Value])>,
}

/// Returns the schema that a reference points to.
fn target(root: &'static Value, at: &'static Value) -> Option<&'static Value> {
    root.pointer(at.get("$ref")?.as_str()?.strip_prefix('#')?)
}

/// Returns the first result of `find` for a schema, for its target, and for its only form other than null.
fn found<T>(
    root: &'static Value,
    at: &'static Value,
    find: &dyn Fn(&'static Value) -> Option<T>,
) -> Option<T> {
    find(at).or_else(|| found(root, target(root, at)?, find)).or_else(|| {
        let forms = at.get("anyOf")?.as_array()?.iter();
        forms.filter(|form| form["type"] != "null").find_map(|form| found(root, form, find))
    })
}

/// Whether a schema has a range anywhere; parts nested deeper than `depth` count as having one.
fn ranged(root: &'static Value, at: &'static Value, depth: u32) -> bool {
    const LIMITS: [&str; 3] = ["minimum", "maximum", "exclusiveMinimum"];
    match at {
        _ if depth == 0 => true,
        Value::Array(parts) => parts.iter().any(|part| ranged(root, part, depth)),
        Value::Object(fields) => {
            // An unsigned number needs no least value of 0.
            let unsigned = at["minimum"] == 0 && at["format"].as_str().is_some_and(|f| f.starts_with("uint"));
            LIMITS[usize::from(unsigned)..].iter().any(|limit| fields.contains_key(*limit))
                || fields.values().any(|part| ranged(root, part, depth - 1))
                || target(root, at).is_some_and(|to| ranged(root, to, depth - 1))
        }
        _ => false,
    }
}

impl<'a> Look<'a> {
    fn number(self, value: f64) -> Result<Variant, Stop> {
        let Some(at) = self.at else { return Ok(None) };
        let limit = |name| found(self.root, at, &|s| s.get(name)?.as_f64());
        let (least, most, above) = (limit("minimum"), limit("maximum"), limit("exclusiveMinimum"));
        let inside = least.is_none_or(|l| value >= l)
            && most.is_none_or(|m| value <= m)
            && above.is_none_or(|a| value > a);
        if inside {
            return Ok(None);
        }
        let unit = found(self.root, at, &|s| s.get("x-unit")?.as_str()).unwrap_or_default();
        Err(Stop(Some(Box::new(RangeFault {
            path: self.trail.to_string(),
            value,
            least,
            most,
            above,
            unit,
        }))))
    }

    fn within(self, trail: &'a Trail<'a>, at: Option<&'static Value>) -> Self {
        Self { at, trail, tag: None, ..self }
    }

    fn rows(self) -> Rows<'a> {
        let part = |name| self.at.and_then(|at| found(self.root, at, &|s| s.get(name)));
        // A mesh has millions of numbers without a range: they are not checked one by one.
        let all = part("items").filter(|s| ranged(self.root, s, 8));
        Rows { look: self, row: 0, own: part("prefixItems"), all }
    }

    fn fields(self) -> Fields<'a> {
        Fields { look: self, key: String::new() }
    }

    /// Returns the schema of a field.
    fn field(&self, key: &str) -> Option<&'static Value> {
        found(self.root, self.at?, &|s| s.get("properties")?.get(key))
    }

    /// Returns the forms that the value of `key` distinguishes.
    fn forms(&self, key: &str) -> Option<&'static [Value]> {
        let forms = found(self.root, self.at?, &|s| s.get("oneOf")?.as_array())?;
        forms.iter().any(|f| f["properties"][key].get("const").is_some()).then_some(&forms[..])
    }

    /// Returns the form that is written as a table with its name as the only key.
    fn variant(self, name: &'static str) -> Option<&'static Value> {
        found(self.root, self.at?, &|s| {
            s.get("oneOf")?.as_array()?.iter().find_map(|f| f.get("properties")?.get(name))
        })
    }
}

macro_rules! numbers {
    ($($name:ident $of:ty),*) => {$(
        fn $name(self, value: $of) -> Result<Variant, Stop> {
            self.number(value.into())
        }
    )*};
}

impl<'a> Serializer for Look<'a> {
    type Ok = Variant;
    type Error = Stop;
    type SerializeSeq = Rows<'a>;
    type SerializeTuple = Rows<'a>;
    type SerializeTupleStruct = Rows<'a>;
    type SerializeTupleVariant = Rows<'a>;
    type SerializeMap = Fields<'a>;
    type SerializeStruct = Fields<'a>;
    type SerializeStructVariant = Inner<'a>;

    numbers!(serialize_i8 i8, serialize_i16 i16, serialize_i32 i32, serialize_u8 u8, serialize_u16 u16,
        serialize_u32 u32, serialize_f32 f32, serialize_f64 f64);

    fn serialize_bool(self, _value: bool) -> Result<Variant, Stop> {
        Ok(None)
    }

    #[expect(clippy::cast_precision_loss, reason = "to be compared with a limit")]
    fn serialize_i64(self, value: i64) -> Result<Variant, Stop> {
        self.number(value as f64)
    }

    #[expect(clippy::cast_precision_loss, reason = "to be compared with a limit")]
    fn serialize_u64(self, value: u64) -> Result<Variant, Stop> {
        self.number(value as f64)
    }

    fn serialize_char(self, _value: char) -> Result<Variant, Stop> {
        Ok(None)
    }

    fn serialize_str(self, value: &str) -> Result<Variant, Stop> {
        let Some((key, forms)) = self.tag else { return Ok(None) };
        Ok(forms.iter().position(|f| f["properties"][key]["const"] == value))
    }

    fn serialize_bytes(self, _value: &[u8]) -> Result<Variant, Stop> {
        Ok(None)
    }

    fn serialize_none(self) -> Result<Variant, Stop> {
        Ok(None)
    }

    fn serialize_some<T: Serialize + ?Sized>(self, value: &T) -> Result<Variant, Stop> {
        value.serialize(self)
    }

    fn serialize_unit(self) -> Result<Variant, Stop> {
        Ok(None)
    }

    fn serialize_unit_struct(self, _name: &'static str) -> Result<Variant, Stop> {
        Ok(None)
    }

    fn serialize_unit_variant(self, _: &'static str, _: u32, variant: &'static str) -> Result<Variant, Stop> {
        self.serialize_str(variant)
    }

    fn serialize_newtype_struct<T: Serialize + ?Sized>(
        self,
        _: &'static str,
        value: &T,
    ) -> Result<Variant, Stop> {
        value.serialize(self)
    }

    fn serialize_newtype_variant<T: Serialize + ?Sized>(
        self,
        _: &'static str,
        _: u32,
        variant: &'static str,
        value: &T,
    ) -> Result<Variant, Stop> {
        value.serialize(self.within(&Trail::Field(self.trail, variant), self.variant(variant)))
    }

    fn serialize_seq(self, _length: Option<usize>) -> Result<Rows<'a>, Stop> {
        Ok(self.rows())
    }

    fn serialize_tuple(self, _length: usize) -> Result<Rows<'a>, Stop> {
        Ok(self.rows())
    }

    fn serialize_tuple_struct(self, _: &'static str, _length: usize) -> Result<Rows<'a>, Stop> {
        Ok(self.rows())
    }

    fn serialize_tuple_variant(
        self,
        _: &'static str,
        _: u32,
        variant: &'static str,
        _length: usize,
    ) -> Result<Rows<'a>, Stop> {
        Ok(Look { at: self.variant(variant), ..self }.rows())
    }

    fn serialize_map(self, _length: Option<usize>) -> Result<Fields<'a>, Stop> {
        Ok(self.fields())
    }

    fn serialize_struct(self, _: &'static str, _length: usize) -> Result<Fields<'a>, Stop> {
        Ok(self.fields())
    }

    fn serialize_struct_variant(
        self,
        _: &'static str,
        _: u32,
        variant: &'static str,
        _length: usize,
    ) -> Result<Inner<'a>, Stop> {
        Ok(Inner { look: Look { at: self.variant(variant), ..self }, variant })
    }
}

/// Checks the rows of a list.
struct Rows<'a> {
    look: Look<'a>,
    row: usize,
    /// The schemas of single rows.
    own: Option<&'static Value>,
    /// The schema of all other rows, where it has a range.
    all: Option<&'static Value>,
}

impl Rows<'_> {
    fn next<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), Stop> {
        let row = self.row;
        self.row += 1;
        let at = self.own.and_then(|own| own.get(row)).or(self.all);
        value.serialize(self.look.within(&Trail::Row(self.look.trail, row), at)).map(|_| ())
    }
}

macro_rules! rows {
    ($($of:ident $name:ident),*) => {$(
        impl $of for Rows<'_> {
            type Ok = Variant;
            type Error = Stop;

            fn $name<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), Stop> {
                self.next(value)
            }

            fn end(self) -> Result<Variant, Stop> {
                Ok(None)
            }
        }
    )*};
}

rows!(SerializeSeq serialize_element, SerializeTuple serialize_element, SerializeTupleStruct serialize_field,
    SerializeTupleVariant serialize_field);

/// Checks the fields of a table.
struct Fields<'a> {
    look: Look<'a>,
    /// The last key of a map.
    key: String,
}

impl Fields<'_> {
    fn next<T: Serialize + ?Sized>(&mut self, key: &str, value: &T) -> Result<(), Stop> {
        let trail = Trail::Field(self.look.trail, key);
        // Serde writes the tag first.
        if let Some(forms) = self.look.forms(key) {
            let tag = self.look.within(&trail, None);
            // Keys of schemas live as long as the schemas, and this key is that of a form.
            let key =
                forms.iter().find_map(|f| Some(f["properties"].as_object()?.get_key_value(key)?.0.as_str()));
            let form = value.serialize(Look { tag: key.map(|k| (k, forms)), ..tag })?;
            self.look.at = form.map(|k| &forms[k]);
            return Ok(());
        }
        value.serialize(self.look.within(&trail, self.look.field(key))).map(|_| ())
    }
}

impl SerializeStruct for Fields<'_> {
    type Ok = Variant;
    type Error = Stop;

    fn serialize_field<T: Serialize + ?Sized>(&mut self, key: &'static str, value: &T) -> Result<(), Stop> {
        self.next(key, value)
    }

    fn end(self) -> Result<Variant, Stop> {
        Ok(None)
    }
}

impl SerializeMap for Fields<'_> {
    type Ok = Variant;
    type Error = Stop;

    fn serialize_key<T: Serialize + ?Sized>(&mut self, key: &T) -> Result<(), Stop> {
        let text = serde_json::to_value(key).map_err(serde::ser::Error::custom)?;
        self.key = text.as_str().unwrap_or_default().to_owned();
        Ok(())
    }

    fn serialize_value<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), Stop> {
        let key = core::mem::take(&mut self.key);
        self.next(&key, value)
    }

    fn end(self) -> Result<Variant, Stop> {
        Ok(None)
    }
}

/// Checks the fields of a form that is written as a table with its name as the only key.
struct Inner<'a> {
    look: Look<'a>,
    variant: &'static str,
}

impl SerializeStructVariant for Inner<'_> {
    type Ok = Variant;
    type Error = Stop;

    fn serialize_field<T: Serialize + ?Sized>(&mut self, key: &'static str, value: &T) -> Result<(), Stop> {
        let up = Trail::Field(self.look.trail, self.variant);
        value.serialize(self.look.within(&Trail::Field(&up, key), self.look.field(key))).map(|_| ())
    }

    fn end(self) -> Result<Variant, Stop> {
        Ok(None)
    }
}

#[cfg(test)]
mod tests {
    use schemars::JsonSchema;
    use serde::{Deserialize, Serialize};

    use super::*;

    #[derive(Clone, Serialize, Deserialize, JsonSchema)]
    struct Bed {
        #[schemars(range(min = 0.0, max = 1.0), extend("x-unit" = "m"))]
        depth_m: f64,
        #[schemars(range(min = 1, max = 9))]
        rows: Option<u32>,
        plants: Vec<Plant>,
        #[schemars(inner(range(min = 0.0)))]
        heights: Vec<f64>,
        corner: (f64, Soil),
        free: f64,
    }

    #[derive(Clone, Serialize, Deserialize, JsonSchema)]
    #[serde(tag = "kind", rename_all = "kebab-case")]
    enum Plant {
        Bean {
            #[schemars(range(max = 20))]
            pods: u32,
        },
        Oak(Soil),
        Moss,
    }

    #[derive(Clone, Serialize, Deserialize, JsonSchema)]
    struct Soil {
        #[schemars(range(min = 3.0, max = 9.0))]
        ph: f64,
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        wet: f64,
    }

    #[derive(Clone, Serialize, Deserialize, JsonSchema)]
    enum Gift {
        Bed(Box<Bed>),
        Soil {
            #[schemars(range(min = 3.0))]
            ph: f64,
        },
        Pair(u8, Soil),
    }

    crate::schemas!(Bed, Gift);

    fn sound() -> Bed {
        Bed {
            depth_m: 0.4,
            rows: None,
            plants: vec![Plant::Moss, Plant::Bean { pods: 3 }, Plant::Oak(soil(5.0))],
            heights: vec![0.0, 2.0],
            corner: (0.0, soil(7.0)),
            free: f64::MAX,
        }
    }

    const fn soil(ph: f64) -> Soil {
        Soil { ph, wet: 0.5 }
    }

    fn fault<T: Spec>(value: &T) -> String {
        check(value).map_or_else(|e| e.to_string(), |()| String::new())
    }

    #[test]
    fn every_number_is_held_against_its_range() {
        assert_eq!(fault(&sound()), "");
        let bed = |change: &dyn Fn(&mut Bed)| {
            let mut bed = sound();
            change(&mut bed);
            fault(&bed)
        };
        assert_eq!(bed(&|b| b.depth_m = 1.5), "depth_m must be 0 to 1 m, not 1.5");
        assert_eq!(bed(&|b| b.depth_m = f64::NAN), "depth_m must be 0 to 1 m, not NaN");
        assert_eq!(bed(&|b| b.rows = Some(0)), "rows must be 1 to 9, not 0");
        assert_eq!(bed(&|b| b.rows = Some(9)), "");
        assert_eq!(
            bed(&|b| b.plants[1] = Plant::Bean { pods: 21 }),
            "plants[1].pods must be 0 to 20, not 21"
        );
        assert_eq!(bed(&|b| b.plants[2] = Plant::Oak(soil(2.0))), "plants[2].ph must be 3 to 9, not 2");
        assert_eq!(bed(&|b| b.heights[1] = -1.0), "heights[1] must be 0 or more, not -1");
        assert_eq!(bed(&|b| b.corner.1.ph = 12.0), "corner[1].ph must be 3 to 9, not 12");
        assert_eq!(bed(&|b| b.corner.1.wet = 0.0), "corner[1].wet must be above 0, not 0");
    }

    #[test]
    fn forms_that_are_named_from_outside_are_held_too() {
        let mut bed = sound();
        bed.depth_m = -1.0;
        assert_eq!(fault(&Gift::Bed(Box::new(bed))), "Bed.depth_m must be 0 to 1 m, not -1");
        assert_eq!(fault(&Gift::Soil { ph: 1.0 }), "Soil.ph must be 3 or more, not 1");
        assert_eq!(fault(&Gift::Pair(1, soil(1.0))), "[1].ph must be 3 to 9, not 1");
        assert_eq!(fault(&Gift::Pair(1, soil(4.0))), "");
    }
}
