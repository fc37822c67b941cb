//! Pictures of materials.

use base::LiteMap;
use std::sync::{Arc, OnceLock};

use base::Digest;
use mesh::Texture;
use skin::{OrganMaterial, Pattern};

use crate::SettingFault;
use crate::photo::png_size;

/// Most bytes of a picture: 8 MiB.
const MAX_PICTURE_BYTES: usize = 8 << 20;
/// Longest side of a picture, pixels.
const MAX_SIDE: u32 = 2048;

/// A picture of a material that organs wear.
///
/// It is stored as PNG, which every platform decodes to the same pixels. Two pictures are equal if their files are.
#[derive(Clone)]
pub struct WornPicture {
    png: Arc<[u8]>,
    decoded: Arc<OnceLock<Option<Arc<Texture>>>>,
}

impl PartialEq for WornPicture {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.png, &other.png) || self.png == other.png
    }
}

impl std::fmt::Debug for WornPicture {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "WornPicture {{ {} bytes }}", self.png.len())
    }
}

/// Reason why a picture was not accepted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum PictureError {
    /// The bytes do not start like a PNG.
    #[error("the picture is no PNG; save it as PNG")]
    NotPng,
    /// The picture exceeds the bounds.
    #[error("the picture has more than {MAX_SIDE} pixels a side or 8 MB; make it smaller")]
    TooLarge,
}

impl WornPicture {
    /// Makes a picture from the bytes of a PNG.
    ///
    /// Guaranteed: its size is read from the header and bounded. Not guaranteed: that its pixels decode.
    ///
    /// # Errors
    /// [`PictureError`] if it is not a PNG or is too large.
    ///
    /// ```
    /// assert!(document::WornPicture::new(b"GIF89a".as_slice().into()).is_err());
    /// ```
    pub fn new(png: Arc<[u8]>) -> Result<Self, PictureError> {
        let (width, height) = png_size(&png).ok_or(PictureError::NotPng)?;
        if width.max(height) > MAX_SIDE || png.len() > MAX_PICTURE_BYTES {
            return Err(PictureError::TooLarge);
        }
        Ok(Self { png, decoded: Arc::default() })
    }

    /// Returns its bytes.
    pub fn png(&self) -> &Arc<[u8]> {
        &self.png
    }

    /// Returns the name under which it is stored: the same for the same bytes.
    pub fn name(&self) -> String {
        let mut digest = Digest::new();
        digest.bytes(&self.png);
        digest.hex().chars().take(16).collect()
    }

    /// Returns its pixels, decoded by `decode` at the first call; `None` if they do not decode.
    pub fn texture(&self, decode: impl FnOnce(&[u8]) -> Option<Texture>) -> Option<Arc<Texture>> {
        self.decoded.get_or_init(|| decode(&self.png).map(Arc::new)).clone()
    }
}

/// Pictures by their names.
pub type WornPictures = LiteMap<String, WornPicture>;

/// Returns the fault in a material of a plant that has these pictures.
pub(crate) fn material_fault(material: &OrganMaterial, pictures: &WornPictures) -> Option<SettingFault> {
    if let Err(fault) = spec::check(material) {
        return Some(SettingFault::Range(fault));
    }
    let named = material.picture.as_deref();
    let there = named.map_or(material.pattern != Pattern::Picture, |name| pictures.contains_key(name));
    (!there).then_some(SettingFault::Picture)
}

base::coded!(PictureError {
    Self::NotPng => "picture-not-png" {},
    Self::TooLarge => "picture-too-large" {},
});
