/** A document in the address: a small project file, in base64url behind the hash, which no server ever sees. */

/** Longest link: mail and chat programs cut longer ones. */
export const MAX_LINK = 32_000;
const KEY = '#d=';

export function encode(bytes: Uint8Array): string {
  let text = '';
  for (const b of bytes) text += String.fromCharCode(b);
  return btoa(text).replaceAll('+', '-').replaceAll('/', '_').replace(/=+$/, '');
}

/** The bytes of a link's hash; undefined if it is none of ours or cannot be one. What they hold is not believed here. */
export function decode(hash: string): Uint8Array | undefined {
  const text = hash.startsWith(KEY) ? hash.slice(KEY.length) : '';
  if (text === '' || text.length > MAX_LINK || !/^[\w-]+$/.test(text)) return undefined;
  try {
    return Uint8Array.from(atob(text.replaceAll('-', '+').replaceAll('_', '/')), (c) => c.charCodeAt(0));
  } catch {
    return undefined;
  }
}

export function isLink(hash: string): boolean {
  return hash.startsWith(KEY);
}

/** The link to a document on this page; undefined if it would be too long. */
export function link(bytes: Uint8Array): string | undefined {
  const text = encode(bytes);
  return text.length > MAX_LINK ? undefined : `${location.origin}${location.pathname}${KEY}${text}`;
}
