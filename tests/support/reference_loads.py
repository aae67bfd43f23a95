"""Plain Python readings of the layered load models, which the kernels must equal."""

from __future__ import annotations

import numpy as np

from growth.blocks.body import BOUNDARY


def reference_depths(body):
    cells = [tuple(cell) for cell in body.cells.tolist()]
    place = {cell: k for k, cell in enumerate(cells)}
    depth = [0 if system == BOUNDARY else -1 for system in body.systems.tolist()]
    front = [k for k, d in enumerate(depth) if d == 0]
    while front:
        following = []
        for k in front:
            for offset in body.lattice.offsets.tolist():
                near = place.get(tuple(a + b for a, b in zip(cells[k], offset, strict=True)), -1)
                if near >= 0 and depth[near] < 0:
                    depth[near] = depth[k] + 1
                    following.append(near)
        front = following
    return depth


def reference_parts(body, layers):
    """For each joint the places of the blocks above it: flood from its upper block over blocks as deep or deeper."""
    near = {k: [] for k in range(len(body.cells))}
    for a, b in layers.joints.tolist():
        near[a].append(b)
        near[b].append(a)
    out = []
    for _, top in layers.joints.tolist():
        least = layers.depth[top]
        seen, stack = {top}, [top]
        while stack:
            for k in near[stack.pop()]:
                if layers.depth[k] >= least and k not in seen:
                    seen.add(k)
                    stack.append(k)
        out.append(sorted(seen))
    return out


def groups(body, layers):
    """The joints of each part, by its blocks."""
    found = {}
    for place, members in enumerate(reference_parts(body, layers)):
        low, high = layers.depth[layers.joints[place]]
        if high == low + 1:
            found.setdefault(tuple(members), []).append(place)
    return found


def cross(v):
    x, y, z = v
    return np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])


def reference_rigid(body, layers, stiffness):
    """The full 6x6 system of each part, about the origin."""
    forces, moments = np.zeros((2, len(layers.joints), 3))
    for members, joints in groups(body, layers).items():
        whole = np.zeros((6, 6))
        arms = {}
        for j in joints:
            s = stiffness[layers.kinds[j]]
            to_joint = np.hstack([np.eye(3), -cross(layers.points[j])])  # u + turn x r
            spring, turn = s * np.eye(3), s / 12 * np.eye(3)
            whole += to_joint.T @ spring @ to_joint
            whole[3:, 3:] += turn
            arms[j] = (spring @ to_joint, np.hstack([np.zeros((3, 3)), turn]))
        weight = np.array([0, 0, -len(members)])
        moved = np.linalg.solve(whole, np.r_[weight, np.cross(body.cells[list(members)].mean(axis=0), weight)])
        for j, (force, moment) in arms.items():
            forces[j], moments[j] = force @ moved, moment @ moved
    return forces, moments


def reference_galasyn(body, layers, stiffness):
    """Vectors joint by joint, as docs/blocks.md tells."""
    forces, moments = np.zeros((2, len(layers.joints), 3))
    for members, joints in groups(body, layers).items():
        centre = body.cells[list(members)].mean(axis=0)
        total = sum(stiffness[layers.kinds[j]] for j in joints)
        share = {j: np.array([0, 0, -len(members)]) * stiffness[layers.kinds[j]] / total for j in joints}
        across = {}
        for j in joints:
            line = layers.points[j] - centre
            square = line @ line
            along = share[j] @ line / square * line if square else np.zeros(3)
            across[j] = share[j] - along
            if np.linalg.norm(across[j]) < 1e-9 * len(members):
                across[j] = np.zeros(3)
            forces[j] += along
        for i in joints:
            if not across[i].any():
                continue
            moment = np.cross(centre - layers.points[i], across[i])
            others = [j for j in joints if (layers.points[j] != layers.points[i]).any()]
            if not others:
                forces[i] += across[i]
                moments[i] += moment
                continue
            sizes = np.array([np.linalg.norm(across[j]) for j in others])
            parts = sizes / sizes.sum() if sizes.sum() else np.full(len(others), 1 / len(others))
            for j, part in zip(others, parts, strict=True):
                line = layers.points[j] - layers.points[i]
                forces[j] += part * np.cross(moment, line) / (line @ line)
                moments[i] += part * (moment @ line) / (line @ line) * line
    return forces, moments
