//! Answers of the server.

use std::borrow::Cow;

/// Headers of every answer, including refusals.
pub(super) const ALWAYS: &str = "X-Content-Type-Options: nosniff\r\nReferrer-Policy: no-referrer\r\n\
    Cross-Origin-Opener-Policy: same-origin\r\nCross-Origin-Embedder-Policy: require-corp\r\n\
    Cross-Origin-Resource-Policy: same-origin\r\nPermissions-Policy: camera=(), microphone=(), geolocation=()\r\n\
    Connection: close\r\n";

/// Status line, headers with the empty line, and the body (empty for HEAD).
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Answer {
    pub(crate) status: u16,
    pub(crate) head: String,
    pub(crate) body: Cow<'static, [u8]>,
}

impl Answer {
    /// Returns the answer to a request with this head: for HEAD the headers only, including refusals.
    pub(crate) fn to(self, head: &[u8]) -> Self {
        let body = if head.starts_with(b"HEAD ") { Cow::default() } else { self.body };
        Self { body, ..self }
    }
}
