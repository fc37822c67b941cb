//! Admission from the network: a link and a code that work once, and the cookie that a browser gets for them.
//!
//! Guaranteed: without the key of the link, the code, or a cookie obtained by one of them, the only answer is that it
//! is needed; each works once, and opening a link does not use it up; guesses are few. Nothing here reads a clock or a
//! random number: both are passed in.

use std::collections::BTreeMap;
use std::net::IpAddr;
use std::time::{Duration, Instant};

/// Number of digits of a code.
const DIGITS: usize = 8;
/// Wrong codes after which a new one is shown.
const WRONG: u32 = 5;
/// Wrong codes after which codes are no longer accepted.
pub(crate) const MOST_WRONG: u32 = 25;
/// Most browsers that are admitted at one time; the first is dropped when one more comes.
const BROWSERS: usize = 16;

/// Source of random bytes.
pub(crate) type Random = fn(&mut [u8]);

/// The key of a link, and a code: either of them is enough.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Invitation {
    /// 32 hexadecimal digits.
    pub(crate) key: String,
    /// 8 digits; `None` after too many wrong ones.
    pub(crate) code: Option<String>,
}

/// Result of an attempt to enter.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Entry {
    /// Admitted, with the cookie of the browser; the next browser needs another invitation.
    In(String),
    /// The code is wrong.
    Wrong,
    /// The code is wrong, and there were too many wrong ones: there is a new one, or none any more.
    Renewed,
    /// Codes are no longer accepted.
    Stopped,
}

/// State of the door.
#[derive(Debug)]
pub(crate) struct Gate {
    random: Random,
    invitation: Invitation,
    wrong: u32,
    browsers: Vec<String>,
}

impl Gate {
    pub(crate) fn new(random: Random) -> Self {
        let invitation = Invitation { key: String::new(), code: None };
        let mut gate = Self { random, invitation, wrong: 0, browsers: Vec::new() };
        gate.renew();
        gate
    }

    /// Whether this is the key of the link, which stays valid: programs that show a preview of a link open it, too.
    pub(crate) fn is_key(&self, key: &str) -> bool {
        is_same(&self.invitation.key, key)
    }

    /// Returns the invitation of the next browser.
    pub(crate) fn invitation(&self) -> &Invitation {
        &self.invitation
    }

    /// Whether a browser is admitted.
    pub(crate) fn knows(&self, cookie: &str) -> bool {
        self.browsers.iter().fold(false, |found, own| found | is_same(own, cookie))
    }

    /// Admits a browser by the key of the link.
    pub(crate) fn by_key(&mut self, key: &str) -> Entry {
        if self.is_key(key) { self.enter() } else { Entry::Wrong }
    }

    /// Admits a browser by the code; spaces and dashes in it are ignored.
    pub(crate) fn by_code(&mut self, code: &str) -> Entry {
        let digits: String = code.chars().filter(|c| !matches!(c, ' ' | '-' | '+')).collect();
        let Some(own) = &self.invitation.code else { return Entry::Stopped };
        if is_same(own, &digits) {
            return self.enter();
        }
        self.wrong += 1;
        if !self.wrong.is_multiple_of(WRONG) {
            return Entry::Wrong;
        }
        self.renew();
        Entry::Renewed
    }

    fn enter(&mut self) -> Entry {
        let own = secret(self.random);
        if self.browsers.len() >= BROWSERS {
            self.browsers.remove(0);
        }
        self.browsers.push(own.clone());
        self.renew();
        Entry::In(own)
    }

    fn renew(&mut self) {
        let mut bytes = [0; 8];
        (self.random)(&mut bytes);
        // 2^64 is so far above 10^8 that no code is likelier than another by more than one part in 10^11.
        let code = format!("{:0DIGITS$}", u64::from_le_bytes(bytes) % 10_u64.pow(8));
        let code = (self.wrong < MOST_WRONG).then_some(code);
        self.invitation = Invitation { key: secret(self.random), code };
    }
}

/// Returns 128 random bits as 32 hexadecimal digits.
pub(crate) fn secret(random: Random) -> String {
    let mut bytes = [0; 16];
    random(&mut bytes);
    format!("{:032x}", u128::from_le_bytes(bytes))
}

/// Whether two secrets are the same, in a time that does not depend on where they differ.
pub(crate) fn is_same(own: &str, given: &str) -> bool {
    let differ = own.bytes().zip(given.bytes()).fold(0, |all, (a, b)| all | (a ^ b));
    own.len() == given.len() && differ == 0
}

/// Rate limit: this many at once, and this many a second after that.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pace {
    pub(crate) at_once: f64,
    pub(crate) per_second: f64,
}

/// Remaining allowance of a [`Pace`] at a moment.
#[derive(Clone, Copy, Debug)]
struct Left {
    count: f64,
    at: Instant,
}

/// Counts the requests of each peer. Cost: bounded, however many peers there are.
#[derive(Debug, Default)]
pub(crate) struct Peers(BTreeMap<IpAddr, Left>);

impl Peers {
    /// Most peers that are counted separately; with more, all counts begin anew.
    const MOST: usize = 1024;

    /// Whether a peer may make one more request.
    pub(crate) fn may(&mut self, peer: IpAddr, pace: Pace, now: Instant) -> bool {
        if self.0.len() >= Self::MOST && !self.0.contains_key(&peer) {
            self.0.clear();
        }
        let left = self.0.entry(peer).or_insert(Left { count: pace.at_once, at: now });
        let since = now.checked_duration_since(left.at).unwrap_or(Duration::ZERO);
        left.count = (left.count + since.as_secs_f64() * pace.per_second).min(pace.at_once);
        left.at = now;
        let may = left.count >= 1.0;
        left.count -= f64::from(u8::from(may));
        may
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicU64, Ordering};

    /// Returns bytes that are never the same twice.
    fn counted(bytes: &mut [u8]) {
        static NEXT: AtomicU64 = AtomicU64::new(1);
        let n = NEXT.fetch_add(0x9E37_79B9_7F4A_7C15, Ordering::Relaxed);
        bytes.iter_mut().zip(n.to_le_bytes().into_iter().cycle()).for_each(|(b, next)| *b = next);
    }

    #[test]
    fn a_link_and_a_code_work_once_each() {
        let mut gate = Gate::new(counted);
        let Invitation { key, code } = gate.invitation().clone();
        let code = code.expect("a code");
        assert!(key.len() == 32 && code.len() == 8 && code.bytes().all(|b| b.is_ascii_digit()));
        assert!(!gate.knows("") && !gate.knows(&key));
        assert!(gate.is_key(&key) && gate.is_key(&key) && !gate.is_key(&key[1..]), "looking uses nothing up");
        let Entry::In(first) = gate.by_key(&key) else { panic!("the link is right") };
        assert!(!gate.is_key(&key), "it is used up");
        assert!(gate.knows(&first) && !gate.knows(&first[1..]));
        assert_eq!(
            (gate.by_key(&key), gate.by_code(&code)),
            (Entry::Wrong, Entry::Wrong),
            "both are used up"
        );
        let next = gate.invitation().code.clone().expect("a new code");
        let spaced = format!("{} {}", &next[..4], &next[4..]);
        assert!(matches!(gate.by_code(&spaced), Entry::In(_)));
        assert!(gate.knows(&first), "the first stays in");
    }

    #[test]
    fn codes_cannot_be_guessed() {
        let mut gate = Gate::new(counted);
        let mut shown = Vec::new();
        for k in 0..1000 {
            shown.extend(gate.invitation().code.clone());
            let renewed = gate.by_code("00000000x") == Entry::Renewed;
            assert_eq!(renewed, k < 25 && k % 5 == 4, "{k}");
        }
        shown.dedup();
        assert_eq!((shown.len(), gate.invitation().code.as_ref()), (5, None));
        assert_eq!(gate.by_code(""), Entry::Stopped);
        let key = gate.invitation().key.clone();
        assert!(matches!(gate.by_key(&key), Entry::In(_)), "the link still works");
        assert_eq!(gate.invitation().code, None, "and no code comes back");
    }

    #[test]
    fn the_oldest_browser_goes_when_many_come() {
        let mut gate = Gate::new(counted);
        let came: Vec<String> = (0..20)
            .map(|_| {
                let key = gate.invitation().key.clone();
                let Entry::In(own) = gate.by_key(&key) else { panic!("the link is right") };
                own
            })
            .collect();
        assert!(came[..4].iter().all(|c| !gate.knows(c)) && came[4..].iter().all(|c| gate.knows(c)));
    }

    #[test]
    fn peers_are_slowed_down_one_by_one() {
        let (mut peers, from) = (Peers::default(), Instant::now());
        let pace = Pace { at_once: 10.0, per_second: 2.0 };
        let peer = |k: u32| IpAddr::from(k.to_be_bytes());
        let passed = |peers: &mut Peers, k, at| (0..1000).filter(|_| peers.may(peer(k), pace, at)).count();
        assert_eq!(passed(&mut peers, 1, from), 10);
        assert_eq!(passed(&mut peers, 2, from), 10, "another is not to blame");
        assert_eq!(passed(&mut peers, 1, from + Duration::from_secs(3)), 6);
        for k in 0..5000 {
            peers.may(peer(k), pace, from);
        }
        assert!(peers.0.len() <= Peers::MOST);
    }
}
