//! A door to the network, for headsets: TLS with a certificate that is made on the spot, a link, a code, a QR code.

use std::net::{IpAddr, Ipv4Addr, UdpSocket};
use std::sync::Arc;
use std::time::{Duration, SystemTime};

use qrcode::QrCode;
use qrcode::render::unicode::Dense1x2;
use rcgen::{CertificateParams, DistinguishedName, DnType, KeyPair};
use rustls::ServerConfig;
use rustls::crypto::{CryptoProvider, ring};
use rustls::pki_types::{PrivateKeyDer, PrivatePkcs8KeyDer};

use super::gate::{Invitation, Random};
use crate::failure::{Failure, Outcome};
use crate::say;

/// How long a certificate is good for; a server that runs longer is started anew.
const GOOD_FOR: Duration = Duration::from_secs(30 * 24 * 60 * 60);
/// Clocks of headsets are not exact.
const SINCE: Duration = Duration::from_secs(24 * 60 * 60);

/// The address by which the network knows this machine: the one that is named, else the one that the way out has.
pub(super) fn address(named: &str) -> Outcome<IpAddr> {
    if !named.is_empty() {
        let wrong = |_| Failure::Bad(format!("--lan={named}: not an address such as 192.168.1.20"));
        return named.parse().map_err(wrong);
    }
    // Nothing is sent: the system only looks which way it would go. The address is one kept for documentation.
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

/// Random bytes of the system. A system without them has no secrets: then nothing is served.
pub(super) const RANDOM: Random = |bytes| {
    if provider().secure_random.fill(bytes).is_err() {
        say::error("the system gives no random numbers; the Studio cannot be served to the network");
        std::process::exit(1);
    }
};

fn provider() -> Arc<CryptoProvider> {
    Arc::new(ring::default_provider())
}

/// A server's side of TLS 1.3 and 1.2 for one address, with a certificate and a key that are in no file.
pub(super) fn tls(address: IpAddr) -> Outcome<Arc<ServerConfig>> {
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
    Ok(Arc::new(config))
}

/// Says how the next browser comes in.
pub(super) fn invite(host: &str, invitation: &Invitation) {
    let link = format!("https://{host}/?key={}", invitation.key);
    say::line("");
    say::line("In the headset's browser, scan this or open the link, which works once:");
    if let Ok(code) = QrCode::new(&link) {
        let drawn = code.render::<Dense1x2>().dark_color(Dense1x2::Light).light_color(Dense1x2::Dark).build();
        drawn.lines().for_each(say::line);
    }
    say::line(&format!("  {link}"));
    if let Some(code) = &invitation.code {
        let (first, last) = code.split_at(4);
        say::line(&format!("Or open https://{host}/ and give the code {first} {last}."));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_address_is_taken_as_it_is_named_and_nothing_else() {
        assert_eq!(address("192.168.1.20").unwrap(), IpAddr::from([192, 168, 1, 20]));
        assert!(address("my-desk").is_err() && address("192.168.1.20:80").is_err());
        // In a machine without a network this says what to do.
        match address("") {
            Ok(own) => assert!(!own.is_loopback() && !own.is_unspecified()),
            Err(e) => assert!(format!("{e:?}").contains("--lan=")),
        }
    }
}
