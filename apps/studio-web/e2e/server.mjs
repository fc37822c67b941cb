/** The real server on a port of its own; it ends with the program that asked for it, however that ends. */
import { spawn } from 'node:child_process';

/** `url`: the page; `link`: the whole link that the terminal shows, with the key to the file that is opened, if there is one. */
export async function serve(burgeon, folder, ...files) {
  const shown = /The Studio is at ((http:\/\/127\.0\.0\.1:\d+\/)\S*)/;
  const [, link, url] = await said(burgeon, ['--folder', folder, ...files], shown);
  return { url, link };
}

/** The server of the network, at this machine's own address: its address, and what its terminal shows. */
export async function serveNetwork(burgeon, folder, file) {
  const shown =
    /((?:[0-9A-F]{2}:){31}[0-9A-F]{2})[\s\S]*(https:\/\/\S+\?key=\S+)\s+Or open (https:\/\/127\.0\.0\.1:\d+\/) and give the code (\d{4} \d{4})/;
  const [, fingerprint, link, url, code] = await said(
    burgeon,
    ['--folder', folder, '--lan=127.0.0.1', file],
    shown,
  );
  return { url, link, code, fingerprint };
}

/** Starts a server and waits until it says this. */
async function said(burgeon, more, words) {
  const args = ['studio', '--no-open', '--port', '0', ...more];
  const server = spawn(burgeon, args, { stdio: ['ignore', 'pipe', 'inherit'] });
  process.on('exit', () => server.kill());
  return new Promise((resolve, reject) => {
    let said = '';
    const early = (code) => reject(new Error(`burgeon studio ended with ${code}`));
    server.stdout.on('data', (d) => {
      said += d;
      const found = words.exec(said);
      if (!found) return;
      server.removeListener('exit', early);
      resolve(found);
    });
    server.on('error', reject);
    server.on('exit', early);
  });
}
