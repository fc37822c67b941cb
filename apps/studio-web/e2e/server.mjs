/** The real server on a port of its own; it ends with the program that asked for it, however that ends. */
import { spawn } from 'node:child_process';

export async function serve(burgeon, folder, ...files) {
  const args = ['studio', '--no-open', '--port', '0', '--folder', folder, ...files];
  const server = spawn(burgeon, args, { stdio: ['ignore', 'pipe', 'inherit'] });
  process.on('exit', () => server.kill());
  return new Promise((resolve, reject) => {
    let said = '';
    const early = (code) => reject(new Error(`burgeon studio ended with ${code}`));
    server.stdout.on('data', (d) => {
      said += d;
      const found = /http:\/\/127\.0\.0\.1:\d+\//.exec(said);
      if (!found) return;
      server.removeListener('exit', early);
      resolve(found[0]);
    });
    server.on('error', reject);
    server.on('exit', early);
  });
}
