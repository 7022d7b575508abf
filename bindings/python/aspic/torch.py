"""Equilibria and motions as differentiable functions of torch."""
import torch


class _Equilibrium(torch.autograd.Function):
    @staticmethod
    def forward(ctx, parameters, equilibrium):
        ctx.equilibrium, ctx.parameters = equilibrium, parameters.detach().cpu().numpy().copy()
        return torch.as_tensor(equilibrium.solve(ctx.parameters), dtype=parameters.dtype, device=parameters.device)

    @staticmethod
    def backward(ctx, qbar):
        ctx.equilibrium.solve(ctx.parameters)  # another solve may have moved it
        gradient = ctx.equilibrium.vjp(qbar.detach().cpu().numpy())
        return torch.as_tensor(gradient, dtype=qbar.dtype, device=qbar.device), None


def equilibrium(equilibrium, parameters):
    """Positions at rest, (n, 3), of an aspic.Equilibrium as a function of its parameters, a tensor (m, p)."""
    return _Equilibrium.apply(parameters, equilibrium)


class _Trajectory(torch.autograd.Function):
    @staticmethod
    def forward(ctx, parameters, q, v, trajectory):
        ctx.trajectory, ctx.inputs = trajectory, [x.detach().cpu().numpy().copy() for x in (parameters, q, v)]
        return torch.as_tensor(trajectory.simulate(*ctx.inputs), dtype=parameters.dtype, device=parameters.device)

    @staticmethod
    def backward(ctx, qbar):
        ctx.trajectory._set(*ctx.inputs)
        gradient = ctx.trajectory.vjp(qbar.detach().cpu().numpy())
        return (*(torch.as_tensor(gradient[key], dtype=qbar.dtype, device=qbar.device)
                  for key in ("parameters", "q", "v")), None)


def trajectory(trajectory, parameters, q, v):
    """The motion, (steps + 1, n, 3), of an aspic.Trajectory as a function of tensors (m, p), (n, 3) and (n, 3)."""
    return _Trajectory.apply(parameters, q, v, trajectory)
