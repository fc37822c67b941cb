//! A colour as people write it.

use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// An sRGB colour, written `#rrggbb`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, JsonSchema)]
#[schemars(with = "String", extend("pattern" = "^#[0-9a-fA-F]{6}$", "x-unit" = "colour"))]
pub struct Colour(pub [u8; 3]);

impl Colour {
    /// Returns the colour in linear light, each channel 0 to 1.
    pub fn linear(self) -> [f64; 3] {
        self.srgb().map(base::linear_of_srgb)
    }

    /// Returns the channels as written, each 0 to 1.
    pub fn srgb(self) -> [f64; 3] {
        self.0.map(|b| f64::from(b) / 255.0)
    }
}

impl Serialize for Colour {
    fn serialize<S: Serializer>(&self, s: S) -> Result<S::Ok, S::Error> {
        let [r, g, b] = self.0;
        s.serialize_str(&format!("#{r:02x}{g:02x}{b:02x}"))
    }
}

impl<'de> Deserialize<'de> for Colour {
    fn deserialize<D: Deserializer<'de>>(d: D) -> Result<Self, D::Error> {
        let text = String::deserialize(d)?;
        let hex = text.strip_prefix('#').filter(|h| h.len() == 6 && h.is_ascii());
        let byte = |i: usize| hex.and_then(|h| u8::from_str_radix(h.get(i..i + 2)?, 16).ok());
        match (byte(0), byte(2), byte(4)) {
            (Some(r), Some(g), Some(b)) => Ok(Self([r, g, b])),
            _ => Err(serde::de::Error::custom(format!("`{text}` is no colour such as \"#4a6b2c\""))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_read_and_written() {
        let read = |text: &str| serde_json::from_str::<Colour>(text);
        assert_eq!(read("\"#10AB05\"").ok(), Some(Colour([0x10, 0xab, 0x05])));
        assert_eq!(serde_json::to_string(&Colour([0x10, 0xab, 0x05])).ok().as_deref(), Some("\"#10ab05\""));
        for wrong in ["\"green\"", "\"#12345\"", "\"#é2345\"", "\"#12345g\""] {
            let error = read(wrong).expect_err(wrong).to_string();
            assert!(error.contains("is no colour"), "{error}");
        }
        assert_eq!(Colour([0, 255, 0]).linear(), [0.0, 1.0, 0.0]);
    }
}
