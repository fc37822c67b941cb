//! The codecs of `EXT_meshopt_compression`: attributes (version 0) and triangles (version 1), as the extension
//! documents their bits.

/// Number of bytes that are coded together.
const GROUP: usize = 16;
/// Least number of bytes for the first element at the end of a stream of attributes.
const TAIL: usize = 32;
/// First byte of a stream of attributes.
const ATTRIBUTES: u8 = 0xa0;
/// First byte of a stream of triangles.
const TRIANGLES: u8 = 0xe1;
/// Frequent pairs of codes for the second and third corner of a triangle.
const PAIRS: [u8; 16] =
    [0x00, 0x76, 0x87, 0x56, 0x67, 0x78, 0xa9, 0x86, 0x65, 0x89, 0x68, 0x98, 0x01, 0x69, 0x00, 0x00];
/// From this code on, the third corner of a triangle at a known edge is not among the recent corners.
const FAR: u32 = 13;

/// Returns the number of elements of one block: as many as fit into 8 KiB, in whole groups, at most 256.
const fn block(stride: usize) -> usize {
    let fits = 8192 / stride / GROUP * GROUP;
    if fits < 256 { fits } else { 256 }
}

const fn zigzag(delta: u8) -> u8 {
    (if delta & 0x80 == 0 { 0 } else { 0xff }) ^ (delta << 1)
}

const fn unzigzag(v: u8) -> u8 {
    (if v & 1 == 0 { 0 } else { 0xff }) ^ (v >> 1)
}

/// Encodes elements of `stride` bytes (a multiple of 4, at most 256) as a stream.
pub(super) fn encode_attributes(bytes: &[u8], stride: usize) -> Vec<u8> {
    let mut out = vec![ATTRIBUTES];
    let first = bytes.get(..stride).map_or_else(|| vec![0; stride], <[u8]>::to_vec);
    let mut last = first.clone();
    for elements in bytes.chunks(block(stride) * stride) {
        let count = elements.len() / stride;
        let mut deltas = vec![0; count.next_multiple_of(GROUP)];
        for k in 0..stride {
            let mut before = last[k];
            for (delta, element) in deltas.iter_mut().zip(elements.chunks_exact(stride)) {
                *delta = zigzag(element[k].wrapping_sub(before));
                before = element[k];
            }
            last[k] = before;
            encode_bytes(&deltas, &mut out);
        }
    }
    out.resize(out.len() + TAIL.saturating_sub(stride), 0);
    out.extend_from_slice(&first);
    out
}

/// Encodes whole groups of bytes, each with as few bits as its bytes need.
fn encode_bytes(bytes: &[u8], out: &mut Vec<u8>) {
    let header = out.len();
    out.resize(header + (bytes.len() / GROUP).div_ceil(4), 0);
    for (g, group) in bytes.chunks_exact(GROUP).enumerate() {
        let size = |log: usize| match log {
            0 => {
                if group.iter().all(|&b| b == 0) {
                    0
                } else {
                    usize::MAX
                }
            }
            3 => GROUP,
            _ => {
                let bits = 1 << log;
                let sentinel = (1_u8 << bits) - 1;
                GROUP * bits / 8 + group.iter().filter(|&&b| b >= sentinel).count()
            }
        };
        let log = (0..4).min_by_key(|&log| size(log)).unwrap_or(3);
        #[expect(clippy::cast_possible_truncation, reason = "0 to 3")]
        let code = (log as u8) << (2 * (g % 4));
        out[header + g / 4] |= code;
        match log {
            0 => {}
            3 => out.extend_from_slice(group),
            _ => {
                let bits = 1 << log;
                let sentinel = (1_u8 << bits) - 1;
                for few in group.chunks_exact(8 / bits) {
                    out.push(few.iter().fold(0, |byte, &b| byte << bits | b.min(sentinel)));
                }
                out.extend(group.iter().filter(|&&b| b >= sentinel));
            }
        }
    }
}

/// Decodes the elements of a stream; none if it is broken.
pub(super) fn decode_attributes(stream: &[u8], count: usize, stride: usize) -> Option<Vec<u8>> {
    if stride == 0 || stride > 256 || !stride.is_multiple_of(4) {
        return None;
    }
    let (&kind, body) = stream.split_first()?;
    let body_end = body.len().checked_sub(TAIL.max(stride))?;
    if kind != ATTRIBUTES {
        return None;
    }
    let mut last = body[body.len() - stride..].to_vec();
    let mut rest = &body[..body_end];
    // A block is not shorter than its headers: a hostile count is refused before memory is taken for it.
    if count / 256 > rest.len() {
        return None;
    }
    let mut out = Vec::new();
    let mut done = 0;
    while done < count {
        let here = block(stride).min(count - done);
        let start = out.len();
        out.resize(start + here * stride, 0);
        for k in 0..stride {
            let deltas = decode_bytes(&mut rest, here.next_multiple_of(GROUP))?;
            let mut before = last[k];
            for (i, &delta) in deltas.iter().take(here).enumerate() {
                before = before.wrapping_add(unzigzag(delta));
                out[start + i * stride + k] = before;
            }
            last[k] = before;
        }
        done += here;
    }
    Some(out)
}

fn decode_bytes(rest: &mut &[u8], count: usize) -> Option<Vec<u8>> {
    let header = take(rest, (count / GROUP).div_ceil(4))?;
    let mut out = Vec::with_capacity(count);
    for g in 0..count / GROUP {
        let log = header[g / 4] >> (2 * (g % 4)) & 3;
        match log {
            0 => out.resize(out.len() + GROUP, 0),
            3 => out.extend_from_slice(take(rest, GROUP)?),
            _ => {
                let bits = 1_usize << log;
                let sentinel = (1_u8 << bits) - 1;
                let packed = take(rest, GROUP * bits / 8)?;
                for &byte in packed {
                    for k in (0..8 / bits).rev() {
                        let b = byte >> (k * bits) & sentinel;
                        out.push(if b == sentinel { take(rest, 1)?[0] } else { b });
                    }
                }
            }
        }
    }
    Some(out)
}

fn take<'a>(rest: &mut &'a [u8], n: usize) -> Option<&'a [u8]> {
    let (head, tail) = rest.split_at_checked(n)?;
    *rest = tail;
    Some(head)
}

/// The last sixteen values, the latest first.
struct Recent<T>([T; 16], usize);

impl<T: Copy> Recent<T> {
    fn push(&mut self, value: T) {
        self.0[self.1] = value;
        self.1 = (self.1 + 1) & 15;
    }

    fn get(&self, back: usize) -> T {
        self.0[self.1.wrapping_sub(1 + back) & 15]
    }

    fn find(&self, is: impl Fn(T) -> bool) -> Option<usize> {
        (0..16).find(|&k| is(self.get(k)))
    }
}

/// State that encoder and decoder of triangles share.
struct Seen {
    edges: Recent<[u32; 2]>,
    corners: Recent<u32>,
    /// The next unused index, if indices come in order.
    next: u32,
    /// The index that was last written in full.
    last: u32,
}

impl Seen {
    fn new() -> Self {
        Self { edges: Recent([[u32::MAX; 2]; 16], 0), corners: Recent([u32::MAX; 16], 0), next: 0, last: 0 }
    }

    fn fresh(&mut self) -> u32 {
        self.next = self.next.wrapping_add(1);
        self.next.wrapping_sub(1)
    }

    fn write(&mut self, index: u32, data: &mut Vec<u8>) {
        let d = index.wrapping_sub(self.last);
        let mut v = (d << 1) ^ (if d >> 31 == 0 { 0 } else { u32::MAX });
        while v > 127 {
            data.push((v & 127) as u8 | 128);
            v >>= 7;
        }
        #[expect(clippy::cast_possible_truncation, reason = "seven bits")]
        data.push(v as u8);
        self.last = index;
    }

    fn read(&mut self, data: &mut &[u8]) -> Option<u32> {
        let mut v = 0_u32;
        for k in 0..5 {
            let byte = take(data, 1)?[0];
            v |= u32::from(byte & 127) << (7 * k);
            if byte < 128 {
                break;
            }
        }
        let d = (v >> 1) ^ (v & 1).wrapping_neg();
        self.last = self.last.wrapping_add(d);
        Some(self.last)
    }
}

/// Encodes triangles as a stream. Corners may come back in another order of the same orientation.
pub(super) fn encode_triangles(triangles: &[[u32; 3]]) -> Vec<u8> {
    let (mut codes, mut data) = (vec![TRIANGLES], Vec::new());
    let mut seen = Seen::new();
    for &[a, b, c] in triangles {
        let turns = [[a, b, c], [b, c, a], [c, a, b]];
        let edge = (0..15).find_map(|k| {
            let edge = seen.edges.get(k);
            turns.iter().find(|t| edge == [t[0], t[1]]).map(|t| (k, *t))
        });
        if let Some((k, [a, b, c])) = edge {
            encode_at_edge(&mut seen, k, [a, b, c], (&mut codes, &mut data));
        } else {
            let turn = if b == seen.next {
                1
            } else if c == seen.next {
                2
            } else {
                0
            };
            alone(&mut seen, turns[turn], (&mut codes, &mut data));
        }
    }
    codes.extend(data);
    codes.extend(PAIRS);
    codes
}

/// Encodes a triangle at one of the recent edges.
#[expect(clippy::cast_possible_truncation, reason = "codes of four bits")]
fn encode_at_edge(
    seen: &mut Seen,
    edge: usize,
    [a, b, c]: [u32; 3],
    (codes, data): (&mut Vec<u8>, &mut Vec<u8>),
) {
    let known = seen.corners.find(|v| v == c).map(|k| k as u32).filter(|k| (1..FAR).contains(k));
    let mut code = match known {
        Some(k) => k,
        None if c == seen.next => {
            seen.fresh();
            0
        }
        None => 15,
    };
    if code == 15 && c.wrapping_add(1) == seen.last {
        (code, seen.last) = (13, c);
    } else if code == 15 && c == seen.last.wrapping_add(1) {
        (code, seen.last) = (14, c);
    }
    codes.push((edge as u8) << 4 | code as u8);
    if code == 15 {
        seen.write(c, data);
    }
    if code == 0 || code >= FAR {
        seen.corners.push(c);
    }
    seen.edges.push([c, b]);
    seen.edges.push([a, c]);
}

/// Encodes a triangle at none of the recent edges.
#[expect(clippy::cast_possible_truncation, reason = "codes of four bits")]
fn alone(seen: &mut Seen, [a, b, c]: [u32; 3], (codes, data): (&mut Vec<u8>, &mut Vec<u8>)) {
    let reset = [a, b, c] == [0, 1, 2] && seen.next > 0;
    if reset {
        seen.next = 0;
        seen.corners.0 = [u32::MAX; 16];
    }
    let known = |seen: &Seen, v: u32| seen.corners.find(|w| w == v).filter(|&k| k < 14);
    // Both are looked up before either is added, because the decoder adds new ones later.
    let (kb, kc) = (known(seen, b), known(seen, c));
    let mut of = |v: u32, known: Option<usize>| match known {
        Some(k) => k as u8 + 1,
        None if v == seen.next => {
            seen.fresh();
            0
        }
        None => 15,
    };
    let (fa, fb, fc) = (of(a, None), of(b, kb), of(c, kc));
    let pair = fb << 4 | fc;
    let table = PAIRS[..14].iter().position(|&p| p == pair);
    match table.filter(|_| fa == 0 && !reset) {
        Some(k) => codes.push(0xf0 | k as u8),
        None => {
            codes.push(0xf0 | 14 | fa);
            data.push(pair);
        }
    }
    for (code, v) in [(fa, a), (fb, b), (fc, c)] {
        if code == 15 {
            seen.write(v, data);
        }
    }
    for (code, v) in [(fa, a), (fb, b), (fc, c)] {
        if code == 0 || code == 15 {
            seen.corners.push(v);
        }
    }
    for edge in [[b, a], [c, b], [a, c]] {
        seen.edges.push(edge);
    }
}

/// Decodes the indices of a stream of triangles; none if it is broken.
pub(super) fn decode_triangles(stream: &[u8], count: usize) -> Option<Vec<u32>> {
    let (&kind, body) = stream.split_first()?;
    if kind != TRIANGLES || !count.is_multiple_of(3) {
        return None;
    }
    let (codes, rest) = body.split_at_checked(count / 3)?;
    let (mut data, pairs) = rest.split_at_checked(rest.len().checked_sub(16)?)?;
    let mut seen = Seen::new();
    let mut out = Vec::with_capacity(count);
    for &code in codes {
        let triangle = if code < 0xf0 {
            let [a, b] = seen.edges.get(usize::from(code >> 4));
            let third = u32::from(code & 15);
            let c = match third {
                0 => seen.fresh(),
                k if k < FAR => seen.corners.get(k as usize),
                15 => seen.read(&mut data)?,
                k => {
                    seen.last = if k == 13 { seen.last.wrapping_sub(1) } else { seen.last.wrapping_add(1) };
                    seen.last
                }
            };
            if third == 0 || third >= FAR {
                seen.corners.push(c);
            }
            seen.edges.push([c, b]);
            seen.edges.push([a, c]);
            [a, b, c]
        } else {
            let table = code < 0xfe;
            let pair = if table { pairs[usize::from(code & 15)] } else { take(&mut data, 1)?[0] };
            if !table && pair == 0 {
                seen.next = 0;
            }
            let codes = [if code == 0xff { 15 } else { 0 }, pair >> 4, pair & 15];
            let mut corners = [0; 3];
            for (corner, code) in corners.iter_mut().zip(codes) {
                *corner = match code {
                    0 => seen.fresh(),
                    15 => 0,
                    k => seen.corners.get(usize::from(k) - 1),
                };
            }
            for (corner, _) in corners.iter_mut().zip(codes).filter(|(_, code)| *code == 15) {
                *corner = seen.read(&mut data)?;
            }
            for (&corner, _) in corners.iter().zip(codes).filter(|(_, code)| matches!(code, 0 | 15)) {
                seen.corners.push(corner);
            }
            let [a, b, c] = corners;
            for edge in [[b, a], [c, b], [a, c]] {
                seen.edges.push(edge);
            }
            corners
        };
        out.extend(triangle);
    }
    Some(out)
}

#[cfg(test)]
mod tests {
    use meshoptimizer_rs::codec;

    use super::*;

    fn noise(n: usize) -> impl Iterator<Item = u32> {
        (0..n).scan(12_345_u32, |state, _| {
            *state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            Some(*state >> 8)
        })
    }

    #[test]
    fn attributes_come_back_whatever_they_are() {
        for stride in [4, 8, 12, 20, 256] {
            for count in [0, 1, 15, 16, 17, 255, 256, 257, 1000] {
                let smooth: Vec<u8> =
                    (0..count * stride).map(|i| u8::try_from(i / stride / 7 % 256).unwrap()).collect();
                let rough: Vec<u8> = noise(count * stride).map(|x| (x & 255) as u8).collect();
                for bytes in [smooth, rough] {
                    let stream = encode_attributes(&bytes, stride);
                    assert_eq!(decode_attributes(&stream, count, stride), Some(bytes), "{stride} {count}");
                    for cut in [0, 1, stream.len() / 2, stream.len() - 1] {
                        // Less than there was: none, or no more than was asked for.
                        let cut = decode_attributes(&stream[..cut], count, stride);
                        assert!(cut.is_none_or(|b| b.len() == count * stride), "{stride} {count}");
                    }
                }
            }
        }
    }

    #[test]
    fn triangles_come_back_turned_at_most() {
        // A grid, a fan, scattered ones, and a mesh that begins again at 0.
        let grid = (0..200_u32).flat_map(|i| [[i, i + 1, i + 21], [i, i + 21, i + 20]]);
        let fan = (1..60_u32).map(|i| [0, i, i + 1]);
        let scattered: Vec<u32> = noise(600).map(|x| x % 5000).collect();
        let scattered = scattered.chunks(3).map(|t| [t[0], t[1], t[2]]);
        let all: Vec<[u32; 3]> = grid.clone().chain(fan).chain(scattered).chain(grid).collect();
        let stream = encode_triangles(&all);
        let back = decode_triangles(&stream, 3 * all.len()).expect("a whole stream");
        for (t, b) in all.iter().zip(back.chunks(3)) {
            let [a, c, d] = *t;
            assert!([[a, c, d], [c, d, a], [d, a, c]].iter().any(|t| t[..] == *b), "{t:?} {b:?}");
        }
        assert!(stream.len() < 6 * all.len(), "{} bytes for {}", stream.len(), all.len());
        for cut in 0..stream.len().min(400) {
            assert!(decode_triangles(&stream[..cut], 3 * all.len()).is_none(), "{cut}");
        }
    }

    #[test]
    fn an_independent_codec_reads_what_is_written_and_writes_what_is_read() {
        let mut work = meshoptimizer_rs::Workspace::default();
        let plain = codec::VertexEncoding::new(0, 0).expect("known");
        for (stride, count) in [(4, 1), (4, 700), (8, 257), (12, 1000), (20, 16), (256, 40)] {
            // Bytes that change little, much, and not at all.
            let rough = noise(count * stride).enumerate();
            let byte = |(i, x): (usize, u32)| u8::try_from(x & [3, 255, 0][i % stride % 3]).unwrap();
            let bytes: Vec<u8> = rough.map(byte).collect();
            let stream = encode_attributes(&bytes, stride);
            let theirs = codec::decode_vertex_buffer(count, stride, &stream, &mut work);
            assert_eq!(theirs.expect("reads"), bytes, "{stride} {count}");
            let stream = codec::encode_vertex_buffer(&bytes, count, stride, plain, &mut work);
            let ours = decode_attributes(&stream.expect("writes"), count, stride);
            assert_eq!(ours, Some(bytes), "{stride} {count}");
        }
        let grid = (0..3000_u32).flat_map(|i| [[i, i + 1, i + 61], [i, i + 61, i + 60]]);
        let far: Vec<u32> = noise(900).map(|x| x % 70_000).collect();
        let all: Vec<[u32; 3]> = grid.chain(far.chunks(3).map(|t| [t[0], t[1], t[2]])).collect();
        let stream = encode_triangles(&all);
        let theirs = codec::decode_index_buffer(3 * all.len(), 4, &stream, &mut work).expect("reads");
        let theirs: Vec<u32> = theirs.as_chunks::<4>().0.iter().map(|b| u32::from_le_bytes(*b)).collect();
        assert_eq!(decode_triangles(&stream, 3 * all.len()), Some(theirs));
        let encoding = codec::IndexEncoding::DEFAULT;
        let stream = codec::encode_index_buffer(all.as_flattened(), encoding, &mut work).expect("writes");
        let theirs = codec::decode_index_buffer(3 * all.len(), 4, &stream, &mut work).expect("reads");
        let theirs: Vec<u32> = theirs.as_chunks::<4>().0.iter().map(|b| u32::from_le_bytes(*b)).collect();
        assert_eq!(decode_triangles(&stream, 3 * all.len()), Some(theirs));
    }
}
