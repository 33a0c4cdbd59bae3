#!/usr/bin/env perl
# Usage: layers.pl [ROOT]
#
# Holds the floors of the code apart: a file in include/billet/FLOOR or source/FLOOR includes only files of its own floor
# and of floors before it in the list below. doc/ tells what lives on each.
use strict;
use warnings;
use File::Find;

my @floors = qw(geometry material friction mechanics parameters scene discretization forces contact solve output);
my @apart  = (['forces', 'contact']);                          # neighbours that must not know each other
my %for_all = map { $_ => 1 } qw(compatibility diagnostic_kinds diagnostics errors registered_type state usage version without_traps);    # billet/NAME.h, for every floor
my %above_all = map { $_ => 1 } qw(simulation main);               # files that may include everything
my %level = map { $floors[$_] => $_ } 0 .. $#floors;

chdir $ARGV[0] or die "layers.pl: no folder $ARGV[0]\n" if @ARGV;
my (@files, @errors);
find({no_chdir => 1, wanted => sub { push @files, $_ if /\.(h|cc)$/ }}, grep { -d } 'include/billet', 'source');
die "layers.pl: no code below include/billet and source\n" unless @files;

for my $file (sort @files)
{
  my ($floor, $name) = $file =~ m{^(?:include/billet|source)/(?:(\w+)/)?(?:.*/)?(\w+)[^/]*$};
  my $free = !defined $floor && $above_all{$name};
  if (defined $floor ? !exists $level{$floor} : !($above_all{$name} || $for_all{$name}))
  {
    push @errors, "$file: on no floor of the list in tests/layers.pl";
    next;
  }

  open my $in, '<', $file or die "$file: $!\n";
  my $text = do { local $/; <$in> };
  close $in;
  # Comments may name anything; keep their line ends and what is in quotes.
  $text =~ s{("(?:\\.|[^"\\\n])*")|//[^\n]*|/\*(.*?)\*/}{defined $1 ? $1 : defined $2 ? $2 =~ s/[^\n]//gr : ''}gse;

  my $number = 0;
  for my $line (split /\n/, $text)
  {
    ++$number;
    push @errors, "$file:$number: only parameters/ knows ParameterHandler"
      if $line =~ /\bParameterHandler\b/ && ($floor // '') ne 'parameters';

    my ($open, $path) = $line =~ /^\s*#\s*include\s*([<"])([^>"]+)/ or next;
    if ($path !~ m{^billet/})
    {
      push @errors, "$file:$number: write \"billet/...\" instead of \"$path\"" if $open eq '"' && $path =~ m{/};
      next;
    }
    next if $free;
    my ($other, $header) = $path =~ m{^billet/(?:(\w+)/)?(?:.*/)?(\w+)\.h$};
    if (!defined $other)
    {
      push @errors, "$file:$number: $path is above the floors" unless $header && $for_all{$header};
    }
    elsif (!exists $level{$other})
    {
      push @errors, "$file:$number: $path is on no floor";
    }
    elsif (!defined $floor)
    {
      push @errors, "$file:$number: what every floor includes must not include $path";
    }
    elsif ($level{$other} > $level{$floor})
    {
      push @errors, "$file:$number: $floor/ comes before $other/, so it must not include $path";
    }
    elsif (grep { my %pair = map { $_ => 1 } @$_; $other ne $floor && $pair{$floor} && $pair{$other} } @apart)
    {
      push @errors, "$file:$number: $floor/ and $other/ must not know each other: $path";
    }
  }
}

print "$_\n" for @errors;
printf "%d files, %d errors\n", scalar @files, scalar @errors;
exit(@errors ? 1 : 0);
