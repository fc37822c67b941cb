/**
 * How Chromium is started. `drawing`: as on machines without a graphics card unless another way is asked for, the page
 * drawn by the processor, WebGL by SwiftShader.
 */
export const flags = (drawing = '--disable-gpu') => [
  '--no-sandbox', drawing, '--enable-unsafe-swiftshader', '--disable-quic', '--no-first-run', '--disable-background-networking',
  '--disable-component-update', '--disable-sync',
];
