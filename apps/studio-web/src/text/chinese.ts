/** All that is Chinese: one file, which is fetched when somebody reads it. */
export { zh } from './zh';
export { zhErrors, zhWarnings, zhWords } from './zh-errors';
export { zhHelp } from './zh-help';
