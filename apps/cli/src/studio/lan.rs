//! The door to the network, for headsets: TLS with a certificate that is made on the spot, a link, a code, a QR code.

use std::net::{IpAddr, Ipv4Addr, UdpSocket};
use std::sync::Arc;
use std::time::{Duration, SystemTime};

use qrcode::QrCode;
use qrcode::render::unicode::Dense1x2;
use rcgen::{CertificateParams, DistinguishedName, DnType, KeyPair};
use rustls::ServerConfig;
use rustls::crypto::{CryptoProvider, ring};
use rustls::pki_types::{PrivateKeyDer, PrivatePkcs8KeyDer};

use sha2::{Digest as _, Sha256};

use super::gate::{Invitation, MOST_WRONG, Random};
use crate::failure::{Failure, Outcome};
use crate::say;

/// Validity of a certificate; a server that runs longer has to be restarted.
const GOOD_FOR: Duration = Duration::from_secs(30 * 24 * 60 * 60);
/// Backdating of a certificate, because clocks of headsets are not exact.
const SINCE: Duration = Duration::from_secs(24 * 60 * 60);

/// Returns the address by which the network knows this machine: the given one, else that of outgoing connections.
pub(super) fn address(named: &str) -> Outcome<IpAddr> {
    if !named.is_empty() {
        let wrong = |_| Failure::Bad(format!("--lan={named}: not an address such as 192.168.1.20"));
        return named.parse().map_err(wrong);
    }
    // Nothing is sent: the system only chooses a route. The address is one reserved for documentation.
    let way = UdpSocket::bind((Ipv4Addr::UNSPECIFIED, 0)).and_then(|s| {
        s.connect((Ipv4Addr::new(192, 0, 2, 1), 9))?;
        s.local_addr()
    });
    match way {
        Ok(own) if !own.ip().is_loopback() && !own.ip().is_unspecified() => Ok(own.ip()),
        _ => Err(Failure::Bad(
            "this machine has no network that could be found; name its address: --lan=192.168.1.20".into(),
        )),
    }
}

/// Fills bytes with random numbers of the system. A system without them has no secrets: then nothing is served.
pub(super) const RANDOM: Random = |bytes| {
    if provider().secure_random.fill(bytes).is_err() {
        say::error("the system gives no random numbers, without which the Studio is not served");
        std::process::exit(1);
    }
};

fn provider() -> Arc<CryptoProvider> {
    Arc::new(ring::default_provider())
}

/// A server's side of TLS 1.3 and 1.2 for one address, with a certificate and a key that are in no file.
#[derive(Clone, Debug)]
pub(crate) struct Identity {
    pub(crate) tls: Arc<ServerConfig>,
    /// The SHA-256 of the certificate, as browsers show it: pairs of hexadecimal digits with colons between them.
    pub(crate) fingerprint: String,
}

fn fingerprint_of(certificate: &[u8]) -> String {
    Sha256::digest(certificate).iter().map(|b| format!("{b:02X}")).collect::<Vec<_>>().join(":")
}

/// Makes a new identity.
pub(super) fn identity(address: IpAddr) -> Outcome<Identity> {
    let fault = |what: &str| Failure::Bad(format!("no certificate could be made: {what}"));
    let key = KeyPair::generate().map_err(|e| fault(&e.to_string()))?;
    let names = vec![address.to_string(), "localhost".into()];
    let mut params = CertificateParams::new(names).map_err(|e| fault(&e.to_string()))?;
    params.distinguished_name = DistinguishedName::new();
    params.distinguished_name.push(DnType::CommonName, "Burgeon Studio");
    let now = SystemTime::now();
    (params.not_before, params.not_after) = ((now - SINCE).into(), (now + GOOD_FOR).into());
    let certificate = params.self_signed(&key).map_err(|e| fault(&e.to_string()))?;
    let secret = PrivateKeyDer::Pkcs8(PrivatePkcs8KeyDer::from(key.serialize_der()));
    let config = ServerConfig::builder_with_provider(provider())
        .with_safe_default_protocol_versions()
        .map_err(|e| fault(&e.to_string()))?
        .with_no_client_auth()
        .with_single_cert(vec![certificate.der().clone()], secret)
        .map_err(|e| fault(&e.to_string()))?;
    Ok(Identity { tls: Arc::new(config), fingerprint: fingerprint_of(certificate.der()) })
}

/// Prints how the next browser can enter.
pub(super) fn invite(host: &str, invitation: &Invitation) {
    invited(host, invitation).iter().for_each(|line| say::line(line));
}

fn invited(host: &str, invitation: &Invitation) -> Vec<String> {
    let link = format!("https://{host}/?key={}", invitation.key);
    let begins =
        "In the headset's browser, scan this or open the link, and press the button there; it works once:";
    let mut lines = vec![String::new(), begins.into()];
    if let Ok(code) = QrCode::new(&link) {
        let drawn = code.render::<Dense1x2>().dark_color(Dense1x2::Light).light_color(Dense1x2::Dark).build();
        lines.extend(drawn.lines().map(str::to_owned));
    }
    lines.push(format!("  {link}"));
    lines.push(match &invitation.code {
        Some(code) => {
            let (first, last) = code.split_at(4);
            format!("Or open https://{host}/ and give the code {first} {last}.")
        }
        None => format!(
            "Codes are not taken any more, because {MOST_WRONG} wrong ones were given: somebody may be guessing. The link \
             still works. To have codes again, stop this program with Ctrl-C and start it anew."
        ),
    });
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_address_is_taken_as_it_is_named_and_nothing_else() {
        assert_eq!(address("192.168.1.20").unwrap(), IpAddr::from([192, 168, 1, 20]));
        assert!(address("my-desk").is_err() && address("192.168.1.20:80").is_err());
        // On a machine without a network, the error gives the remedy.
        match address("") {
            Ok(own) => assert!(!own.is_loopback() && !own.is_unspecified()),
            Err(e) => assert!(format!("{e:?}").contains("--lan=")),
        }
    }

    #[test]
    fn a_fingerprint_is_written_as_browsers_write_it() {
        // The SHA-256 of "abc" (FIPS 180-2, B.1).
        let abc = fingerprint_of(b"abc");
        assert!(abc.starts_with("BA:78:16:BF:8F:01:CF:EA:41:41:40:DE:5D:AE:22:23"), "{abc}");
        assert_eq!(abc.len(), 95);
        let local = IpAddr::from([127, 0, 0, 1]);
        assert_ne!(identity(local).unwrap().fingerprint, identity(local).unwrap().fingerprint);
    }

    #[test]
    fn the_terminal_shows_the_code_or_says_why_there_is_none() {
        let key = "ab".repeat(16);
        let mut invitation = Invitation { key: key.clone(), code: Some("12345678".into()) };
        let lines = invited("192.0.2.7:7734", &invitation);
        assert!(lines.contains(&format!("  https://192.0.2.7:7734/?key={key}")));
        assert!(lines.last().unwrap().ends_with("give the code 1234 5678."));
        invitation.code = None;
        let last = invited("192.0.2.7:7734", &invitation).pop().unwrap();
        assert!(last.contains("25 wrong ones") && last.contains("The link still works"), "{last}");
        assert!(last.contains("start it anew"), "{last}");
    }
}
