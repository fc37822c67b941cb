//! Words in pictures: letters of 3 x 5 pixels.

use burgeon::render::Picture;

/// Rows from above, the leftmost pixel in the highest bit: A to Z, 0 to 9, then a point.
const LETTERS: [[u8; 5]; 37] = [
    [2, 5, 7, 5, 5],
    [6, 5, 6, 5, 6],
    [3, 4, 4, 4, 3],
    [6, 5, 5, 5, 6],
    [7, 4, 6, 4, 7],
    [7, 4, 6, 4, 4],
    [3, 4, 5, 5, 3],
    [5, 5, 7, 5, 5],
    [7, 2, 2, 2, 7],
    [1, 1, 1, 5, 2],
    [5, 5, 6, 5, 5],
    [4, 4, 4, 4, 7],
    [5, 7, 7, 5, 5],
    [6, 5, 5, 5, 5],
    [2, 5, 5, 5, 2],
    [6, 5, 6, 4, 4],
    [2, 5, 5, 6, 3],
    [6, 5, 6, 5, 5],
    [3, 4, 2, 1, 6],
    [7, 2, 2, 2, 2],
    [5, 5, 5, 5, 7],
    [5, 5, 5, 5, 2],
    [5, 5, 7, 7, 5],
    [5, 5, 2, 5, 5],
    [5, 5, 2, 2, 2],
    [7, 1, 2, 4, 7],
    [7, 5, 5, 5, 7],
    [2, 6, 2, 2, 7],
    [7, 1, 7, 4, 7],
    [7, 1, 7, 1, 7],
    [5, 5, 7, 1, 1],
    [7, 4, 7, 1, 7],
    [7, 4, 7, 5, 7],
    [7, 1, 1, 1, 1],
    [7, 5, 7, 5, 7],
    [7, 5, 7, 1, 7],
    [0, 0, 0, 0, 2],
];
/// Distance from the left of a letter to that of the next, in dots of a letter.
pub(crate) const ADVANCE: i64 = 4;

/// Paints a pixel, if it lies within the picture.
pub(crate) fn put_dot(picture: &mut Picture, [x, y]: [i64; 2], colour: [u8; 3]) {
    let (Ok(x), Ok(y)) = (u32::try_from(x), u32::try_from(y)) else { return };
    if x >= picture.width || y >= picture.height {
        return;
    }
    let at = 4 * (y as usize * picture.width as usize + x as usize);
    picture.pixels[at..at + 3].copy_from_slice(&colour);
}

/// Writes a text from its upper left corner; characters other than letters, digits and points are left blank. `dot`:
/// pixels of the picture along each side of a dot of a letter.
pub(crate) fn write_text(picture: &mut Picture, [x, y]: [i64; 2], text: &str, (dot, colour): (i64, [u8; 3])) {
    for (k, c) in (0_i64..).zip(text.bytes()) {
        let letter = match c.to_ascii_uppercase() {
            c @ b'A'..=b'Z' => c - b'A',
            c @ b'0'..=b'9' => 26 + c - b'0',
            b'.' => 36,
            _ => continue,
        };
        for (row, bits) in (0_i64..).zip(LETTERS[usize::from(letter)]) {
            for column in (0..3_i64).filter(|c| bits >> (2 - c) & 1 == 1) {
                let corner = [x + dot * (ADVANCE * k + column), y + dot * row];
                for i in 0..dot * dot {
                    put_dot(picture, [corner[0] + i % dot, corner[1] + i / dot], colour);
                }
            }
        }
    }
}
