//! Pages for a browser that has not been admitted: the ways to enter, and what the terminal shows for them.

use std::borrow::Cow;

use super::answer::{ALWAYS, Answer};
use super::gate::MOST_WRONG;

/// Request to a browser at the door of the network.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Asks<'a> {
    /// The code that the terminal shows.
    Code,
    /// One press of a button, whose link has this key. A program that shows a preview of a link presses nothing.
    Button(&'a str),
    /// A link: codes are no longer accepted.
    Link,
}

/// Form for a code.
const CODE_FORM: &str = "<form method=post action=/enter>\
    <label>The code that the terminal shows · 终端显示的代码\
    <input name=code inputmode=numeric autocomplete=off autofocus maxlength=12></label>\
    <button>Come in · 进入</button></form>";

/// Text in its place once codes are refused.
const LINK_ALONE: &str = "<p>Codes are not taken any more, because too many wrong ones were given. Open the link that the \
    terminal shows, or start the program anew. · 错误代码过多，已不再接受代码。请打开终端显示的链接，或重新启动程序。</p>";

/// Returns the page at the door of the network. `fingerprint`: of the certificate of this server.
pub(crate) fn doorway(why: &str, asks: Asks<'_>, fingerprint: &str) -> Answer {
    let form = match asks {
        Asks::Code => Cow::Borrowed(CODE_FORM),
        // 32 hexadecimal digits, in the form that the gate uses.
        Asks::Button(key) => Cow::Owned(format!(
            "<p>The link is good for one browser. · 此链接只能供一个浏览器使用。</p>\
             <form method=post action=/enter><input type=hidden name=key value=\"{key}\">\
             <button autofocus>Come in · 进入</button></form>"
        )),
        Asks::Link => Cow::Borrowed(LINK_ALONE),
    };
    let body = format!(
        "<h1>Burgeon Studio</h1><p role=alert>{why}</p>{form}\
         <details open><summary>Is this the right computer? · 这是正确的计算机吗？</summary>\
         <p>The SHA-256 fingerprint of the certificate, which the terminal shows, too · 证书的 SHA-256 指纹（终端也会显示）:</p>\
         <p><code>{fingerprint}</code></p>\
         <p>Somebody between you and the computer could write any fingerprint here. Compare what the terminal shows \
         with what the browser itself says of the certificate: press the sign before the address, then look for the \
         certificate and its SHA-256 fingerprint. If the two differ, do not come in. · 若有人在中间冒充，本页上的指纹也可以\
         伪造。请点按地址前的图标，查看浏览器自己显示的证书 SHA-256 指纹，并与终端显示的比较；若不同，请不要进入。</p></details>"
    );
    let forms = "form-action 'self'";
    // Without a referrer a form's origin would be "null".
    page(&body, forms, &ALWAYS.replace("no-referrer", "same-origin"))
}

/// Returns the answer to a browser of this machine without the key of the link.
pub(crate) fn locked() -> Answer {
    page(
        "<h1>Burgeon Studio</h1><p role=alert>The file that was opened is given only to a browser that came by the whole link \
         which the terminal shows: other users of this machine can reach this address, too. Copy the link from the \
         terminal, with everything after <code>key=</code>. · 打开的文件只提供给通过终端所示完整链接进入的浏览器，因为本机的其他\
         用户也能访问此地址。请从终端复制完整链接，包括 <code>key=</code> 之后的部分。</p>",
        "form-action 'none'",
        ALWAYS,
    )
}

/// Returns the message when codes have just been refused.
pub(crate) fn stopped() -> String {
    format!("This is not the code. After {MOST_WRONG} wrong ones no code is taken any more.")
}

/// Returns a separate page, without scripts, that nobody caches.
fn page(body: &str, forms: &str, always: &str) -> Answer {
    let body = format!(
        "<!doctype html><html lang=en><meta charset=utf-8><meta name=viewport content=\"width=device-width\">\
         <title>Burgeon Studio</title><style>body{{font:1.3rem system-ui;margin:10vh auto;max-width:22rem;padding:1rem}}\
         input,button{{font:inherit;padding:.6em;width:100%;box-sizing:border-box;margin:.4em 0}}\
         details{{font-size:.9rem}}code{{overflow-wrap:anywhere}}</style>{body}</html>\n"
    );
    let head = format!(
        "HTTP/1.1 401 Not in\r\nContent-Type: text/html; charset=utf-8\r\nContent-Length: {}\r\nCache-Control: no-store\r\n\
         Content-Security-Policy: default-src 'none'; style-src 'unsafe-inline'; {forms}; \
         frame-ancestors 'none'; base-uri 'none'\r\n{always}\r\n",
        body.len(),
    );
    Answer { status: 401, head, body: body.into_bytes().into() }
}
