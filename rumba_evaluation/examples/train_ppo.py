"""Teaches a robot to sweep rooms by PPO of stable-baselines3, and compares it with bounce in rooms it has never seen.

    pip install 'gymnasium>=1.1' stable-baselines3        # brings PyTorch, which works without a graphics card
    python3 train_ppo.py --minutes 45 --out learned       # writes curve.csv, curve.png and policy.zip there

The robot sees its beams, its bumper and two small maps around itself, and chooses one of six moves every 0.4 s.
"""

import argparse
import csv
import pathlib
import time

import numpy as np
import torch
from stable_baselines3 import PPO
from stable_baselines3.common.callbacks import BaseCallback
from stable_baselines3.common.torch_layers import BaseFeaturesExtractor

from rumba_evaluation.learning.baselines import Bouncing
from rumba_evaluation.learning.coverage_task import CoverageTask
from rumba_evaluation.learning.rooms import rooms
from rumba_evaluation.learning.stable_baselines import CoverageVecEnv
from rumba_evaluation.learning.task_config import TaskConfig
from rumba_sim.model.common.config import from_mapping

ROBOTS = 64
SEEN, UNSEEN = range(200), range(10_000, 10_020)  # numbers of rooms
EPISODES = 40  # in the unseen rooms, for one point of the curve
SECONDS = 300.0  # of an episode
SETTINGS = {'actions': 'discrete', 'hold': 4, 'maps': 2, 'map_size': 16, 'map_pitch': 0.1, 'time_limit': SECONDS,
            'target': 0.98, 'reward': {'swept': 0.25, 'time': 0.02, 'bump': 0.1, 'finish': 10.0}}
USED = ('ranges', 'bumper', 'maps')  # of what the robot sees


def used(seen):
    """The part of what robots see that the policy uses."""
    return {name: seen[name] for name in USED}


class Features(BaseFeaturesExtractor):
    """A small convolutional network for the maps, its result beside beams and bumper."""

    def __init__(self, observation_space):
        """Make the layers."""
        super().__init__(observation_space, 160)
        channels = observation_space['maps'].shape[0]
        self.maps = torch.nn.Sequential(
            torch.nn.Conv2d(channels, 16, 3, stride=2, padding=1), torch.nn.ReLU(),
            torch.nn.Conv2d(16, 32, 3, stride=2, padding=1), torch.nn.ReLU(), torch.nn.Flatten(),
            torch.nn.Linear(32 * 16, 128), torch.nn.ReLU())
        self.rest = torch.nn.Sequential(
            torch.nn.Linear(sum(observation_space[name].shape[0] for name in USED[:-1]), 32), torch.nn.ReLU())

    def forward(self, seen):
        """What the policy and the value build on."""
        rest = torch.cat([seen[name] for name in USED[:-1]], dim=1)
        return torch.cat([self.maps(seen['maps']), self.rest(rest)], dim=1)


def coverage_in_unseen_rooms(act, settings):
    """Mean and least coverage of episodes in the rooms that are for this only, always the same ones."""
    task = CoverageTask(rooms(UNSEEN[0], len(UNSEEN)), EPISODES, from_mapping(TaskConfig, settings, 'settings'))
    seen, done, coverage = task.reset(range(EPISODES)), np.zeros(EPISODES, bool), np.zeros(EPISODES)
    while not done.all():
        outcome = task.step(act(seen), ~done)
        coverage = np.where(done, coverage, outcome.coverage)
        done |= outcome.terminated | outcome.truncated
        seen = task.look()
    return float(coverage.mean()), float(coverage.min())


def bounce():
    """What the strategy bounce reaches there, in the same time from the same poses."""
    return coverage_in_unseen_rooms(Bouncing(EPISODES).act, {**SETTINGS, 'actions': 'continuous', 'hold': 1})


class Watch(BaseCallback):
    """Measures now and then, writes the curve, and ends the training when the time is up."""

    def __init__(self, minutes, folder, others):
        """Watch for so many minutes."""
        super().__init__()
        self._begin, self._minutes, self._folder, self._others = time.monotonic(), minutes, folder, others
        self._next, self.rows, self._coverages = 0.0, [], []

    def _on_step(self):
        self._coverages += [info['coverage'] for info in self.locals['infos'] if 'terminal_observation' in info]
        minutes = (time.monotonic() - self._begin) / 60.0
        if minutes >= self._next:
            self._next = minutes + self._minutes / 10.0
            self.measure(minutes)
        return minutes < self._minutes

    def measure(self, minutes):
        """One more row of the curve."""
        mean, least = coverage_in_unseen_rooms(
            lambda seen: self.model.predict(used(seen), deterministic=False)[0], SETTINGS)
        recent = float(np.mean(self._coverages[-ROBOTS:])) if self._coverages else float('nan')
        self.rows.append((minutes, time.process_time() / 60.0, self.num_timesteps, recent, mean, least))
        print(f'{minutes:6.1f} min, {self.num_timesteps:9,d} steps: in rooms to learn in {recent:.3f}, unseen '
              f'{mean:.3f}, worst {least:.3f}; bounce {self._others[0]:.3f}, worst {self._others[1]:.3f}', flush=True)
        with open(self._folder / 'curve.csv', 'w', newline='') as file:
            writer = csv.writer(file)
            writer.writerow(['minutes', 'cpu_minutes', 'steps', 'coverage_seen', 'coverage_unseen', 'worst_unseen'])
            writer.writerows(self.rows)


def draw(rows, others, path):
    """The curve as a picture."""
    from matplotlib.figure import Figure
    figure = Figure(figsize=(7.0, 4.0), constrained_layout=True)
    axes = figure.add_subplot()
    steps = [row[2] / 1e6 for row in rows]
    axes.plot(steps, [100.0 * row[4] for row in rows], color='#0072B2',
              label=f'PPO, {len(UNSEEN)} rooms that it has never seen')
    axes.plot(steps, [100.0 * row[3] for row in rows], color='#0072B2', linestyle=':', label='PPO, rooms to learn in')
    axes.axhline(100.0 * others[0], color='#D55E00', label='bounce, in those rooms')
    axes.set(xlabel='steps of 0.4 s [million]', ylabel=f'swept after {SECONDS:g} s [%]', ylim=(0.0, 100.0))
    axes.grid(color='#D8D8D8', linewidth=0.6)
    axes.legend(loc='lower right')
    figure.savefig(path, dpi=120)


def main():
    """Learn, and compare."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--minutes', type=float, default=45.0, help='how long to learn')
    parser.add_argument('--threads', type=int, default=2, help='of PyTorch')
    parser.add_argument('--out', type=pathlib.Path, default=pathlib.Path('learned'), help='folder for the results')
    wanted = parser.parse_args()
    wanted.out.mkdir(parents=True, exist_ok=True)
    torch.set_num_threads(wanted.threads)
    others = bounce()
    print(f'bounce in unseen rooms: {others[0]:.3f} after {SECONDS:g} s, worst {others[1]:.3f}', flush=True)
    robots = CoverageVecEnv(ROBOTS, USED, floors=SEEN, settings=SETTINGS)
    robots.seed(1)
    watch = Watch(wanted.minutes, wanted.out, others)
    model = PPO('MultiInputPolicy', robots, n_steps=128, batch_size=1024, n_epochs=4, gamma=0.99, ent_coef=0.01,
                learning_rate=lambda left: 5e-4, seed=1, device='cpu',
                policy_kwargs={'features_extractor_class': Features, 'net_arch': [128]})
    model.learn(10 ** 9, callback=watch)
    watch.measure(wanted.minutes)
    model.save(wanted.out / 'policy.zip')
    draw(watch.rows, others, wanted.out / 'curve.png')


if __name__ == '__main__':
    main()
