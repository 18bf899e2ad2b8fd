import assert from 'node:assert/strict';
import {test} from 'node:test';
import {isReadyFor} from 'page/model/readiness.ts';
import {shownTemperature, startBody} from 'page/model/start_body.ts';

const kBlock = {name: 'block', temperature_c: 20, std_temperature_k: 1, faces: []};
const kUnknown = {name: 'block', temperature_c: null, std_temperature_k: null, faces: []};

test('TheFieldsShowTheFiguresOfTheBlocksFileUntilSomebodyWritesOthers', () => {
  assert.deepEqual(shownTemperature(undefined, kBlock), {celsius: '20', std: '1'});
  assert.deepEqual(shownTemperature({celsius: '25.3'}, kBlock), {celsius: '25.3', std: '1'});
  assert.deepEqual(shownTemperature({celsius: ''}, kBlock), {celsius: '', std: '1'}, 'an emptied field stays empty');
  assert.deepEqual(shownTemperature(undefined, kUnknown), {celsius: '', std: ''});
  assert.deepEqual(shownTemperature(undefined, null), {celsius: '', std: ''});
});

test('ATemperatureIsSentWithItsDeviationWhenItIsNotTheFiles', () => {
  assert.deepEqual(startBody('quick', {operator: 'Ada'}, kBlock), {recipe: 'quick', operator: 'Ada'});
  assert.deepEqual(startBody('quick', {kind: 'check', operator: 'Ada', touching: 'guided', movingMin: '20'}, kBlock),
                   {kind: 'check', operator: 'Ada', arm_moving_min: 20}, 'it has the recipe of its calibration, and the arm touches');
  assert.deepEqual(startBody('quick', {kind: 'qualification'}, kBlock), {kind: 'qualification'}, 'it has touches of its own');
  assert.deepEqual(startBody('quick', {kind: 'tool', tool: 'gripper', touching: 'guided'}, kBlock), {kind: 'tool', tool: 'gripper'},
                   'the daemon knows that a person makes its touches');
  assert.deepEqual(startBody('quick', {temperature: {celsius: '20 '}}, kBlock), {recipe: 'quick'});
  assert.deepEqual(startBody('quick', {temperature: {celsius: '25,3'}}, kBlock),
                   {recipe: 'quick', block_temperature_c: 25.3, std_block_temperature_k: 1});
  assert.deepEqual(startBody('quick', {touching: 'guided', temperature: {std: '0.5'}}, kBlock),
                   {recipe: 'quick', touching: 'guided', block_temperature_c: 20, std_block_temperature_k: 0.5});
});

test('TheMinutesThatTheArmHasMovedAreSentWhenSomebodyWroteThem', () => {
  assert.deepEqual(startBody('quick', {movingMin: '45'}, kBlock), {recipe: 'quick', arm_moving_min: 45});
  assert.deepEqual(startBody('quick', {movingMin: ' '}, kBlock), {recipe: 'quick'});
  assert.deepEqual(startBody('quick', {movingMin: 'long', temperature: {celsius: '25'}}, kBlock),
                   {recipe: 'quick', arm_moving_min: 'long', block_temperature_c: 25, std_block_temperature_k: 1});
});

test('WhatIsMissingOrNoNumberIsLeftToTheDaemonToRefuse', () => {
  assert.deepEqual(startBody('quick', {temperature: {celsius: '25'}}, kUnknown), {recipe: 'quick', block_temperature_c: 25});
  assert.deepEqual(startBody('quick', {temperature: {celsius: 'warm'}}, kBlock),
                   {recipe: 'quick', block_temperature_c: 'warm', std_block_temperature_k: 1});
  assert.deepEqual(startBody('quick', {temperature: {celsius: ''}}, kBlock), {recipe: 'quick', std_block_temperature_k: 1});
});

test('AStartThatBringsATemperatureWaitsForNoneOfTheFile', () => {
  const old = {code: 'temperature_old', detail: 'd'};
  assert.equal(isReadyFor(null, true), false, 'nobody knows');
  assert.equal(isReadyFor([], false), true);
  assert.equal(isReadyFor([old], false), false);
  assert.equal(isReadyFor([old], true), true);
  assert.equal(isReadyFor([old, {code: 'place_lost', detail: 'd'}], true), false);
});
