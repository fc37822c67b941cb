import { describe, expect, it } from 'vitest';
import { CODES } from '../wire';
import { setLanguage, tell, warning } from '.';
import { zhErrors } from './zh-errors';

const placeholders = (text: string): string[] => [...text.matchAll(/\{(\w+)\}/g)].map((m) => m[1]!);

describe('refusals', () => {
  it('have a Chinese text for each code, with fields that the core gives', () => {
    expect(Object.keys(zhErrors).sort()).toEqual(Object.keys(CODES).sort());
    for (const [code, fields] of Object.entries(CODES)) {
      const text = zhErrors[code as keyof typeof CODES];
      expect(text, code).toMatch(/[\u4e00-\u9fff]/);
      expect(fields, code).toEqual(expect.arrayContaining(placeholders(text)));
    }
  });

  it('are told in the language of the page, else in English', async () => {
    const refusal = { code: 'full', fields: { what: 'plants' }, message: 'the document is full' };
    expect(tell(refusal)).toBe('the document is full');
    await setLanguage('zh');
    expect(tell(refusal)).toBe('文档里的植物已满，请新建一个');
    expect(tell({ ...refusal, code: 'new' })).toBe('the document is full');
    await setLanguage('en');
  });

  it('that are one for many say how many, in one language', async () => {
    const told = {
      code: 'stroke-skipped',
      fields: { stroke: '3', more: '19' },
      message: 'English (and 19 more like it)',
    };
    await setLanguage('zh');
    expect(warning(told)).toBe('第 3 笔无法使用，已略去（另有 19 条类似的）');
    await setLanguage('en');
    expect(warning(told)).toBe(told.message);
  });

  it('of edits say in words which edit and why', async () => {
    const told = { code: 'edit-not-done', fields: { edit: '0', word: 'prune', why: 'branch-gone' } };
    await setLanguage('zh');
    expect(warning({ ...told, message: '' })).toBe('手工修改 0（修剪）没有做：枝条已不存在');
    await setLanguage('en');
    expect(warning({ ...told, message: 'edit 0' })).toBe('edit 0');
  });
});
