/** The worker. */
import init, * as core from './core/burgeon_npm.js';
import { serve } from './serve.js';

serve(init().then(() => core));
